#include "models/outputs/skeleton.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "models/io/text.h"
#include "models/motion/joints.h"

namespace gestus::outputs {
namespace {

constexpr std::int64_t kMaxPoints = 1000;

// The rest pose: a T, seen from the front.  Everything of the right arm points to the left of the
// picture, of the left arm to the right, the head up.
Vector3 RestOf(std::int64_t source) {
  constexpr std::int64_t kLShoulder = 4, kNose = 7, kREye = 8, kLEye = 9;
  const double half = std::sqrt(0.5);
  if (source == kREye) return {-half, half, 0};
  if (source == kLEye) return {half, half, 0};
  if (source >= motion::kRShoulder && source < kLShoulder) return {-1, 0, 0};
  if (source >= motion::kRHandRoot && source < motion::kPatsJoints) return {-1, 0, 0};
  if (source >= kLShoulder && source < kNose) return {1, 0, 0};
  if (source >= motion::kLHandRoot && source < motion::kRHandRoot) return {1, 0, 0};
  return {0, 1, 0};
}

// Letters, digits and _, and no name twice.
std::string Unique(const std::string& wanted, std::set<std::string>* names) {
  std::string clean;
  for (const char c : wanted) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    clean += plain ? c : '_';
  }
  if (clean.empty()) clean = "point";
  std::string name = clean;
  for (int n = 2; !names->insert(name).second; ++n) name = clean + "_" + std::to_string(n);
  return name;
}

// Each point's parent, and the root for those whose parents lead nowhere or in a circle.
std::vector<int> ParentsOf(const Figure& body, int neck) {
  const auto n = static_cast<int>(body.points.size());
  std::vector<int> parents;
  for (int i = 0; i < n; ++i) {
    const std::int64_t parent = body.points[static_cast<std::size_t>(i)].parent;
    parents.push_back(
        parent < 0 || parent >= n || parent == i || i == neck ? neck : static_cast<int>(parent));
  }
  for (int i = 0; i < n; ++i) {
    int at = i;
    for (int steps = 0; at != neck && at != kNone && steps <= n; ++steps)
      at = parents[static_cast<std::size_t>(at)];
    if (at != neck && at != kNone) parents[static_cast<std::size_t>(i)] = neck;
  }
  return parents;
}

double QuantileOf(std::vector<double> values, double quantile) {
  const auto at = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double LengthOf(const Skeleton& skeleton, const Motion& motion, int bone, double quantile) {
  std::vector<double> lengths;
  for (std::int64_t t = 0; t < motion.frames; ++t)
    lengths.push_back(Length(Span(skeleton, *motion.body, t, bone)));
  return QuantileOf(std::move(lengths), quantile);
}

// How long the shoulder is, in the unit of the figure.
double ShoulderOf(const Motion& motion, const FormatOptions& options) {
  if (motion.normalised) return motion::kShoulder;
  if (!options.stances.empty()) return options.stances.front().shoulder;
  for (std::size_t i = 0; i < motion.body->points.size(); ++i) {
    if (motion.body->points[i].source != motion::kRShoulder) continue;
    std::vector<double> lengths;
    for (std::int64_t t = 0; t < motion.frames; ++t)
      lengths.push_back(std::hypot(motion.body->x(t, i), motion.body->y(t, i)));
    const double median = QuantileOf(std::move(lengths), 0.5);
    if (median > 0) return median;
  }
  return motion::kShoulder;
}

// Joints depth first, so that the file can be written from them in order.
class JointMaker {
 public:
  JointMaker(const Figure& body, Skeleton* skeleton) : body_(body), skeleton_(skeleton) {
    children_.resize(body.points.size() + 1);
    for (int i = 0; i < std::ssize(body.points); ++i) {
      if (skeleton->IsBone(i)) children_[Place(bone(i).from)].push_back(i);
    }
  }

  void Make() {
    const int neck = skeleton_->neck;
    const int root = Add(neck == kNone ? "Neck" : Name(neck), kNone, {});
    for (const int child : children_[Place(neck)]) Attach(child, root);
  }

 private:
  // Children of the root stand behind those of the points when the neck is none of them.
  std::size_t Place(int point) const {
    return point == kNone ? children_.size() - 1 : static_cast<std::size_t>(point);
  }
  const Bone& bone(int i) const { return skeleton_->bones[static_cast<std::size_t>(i)]; }
  const std::string& Name(int i) const { return body_.points[static_cast<std::size_t>(i)].name; }

  int Add(const std::string& name, int parent, const Vector3& offset) {
    Joint joint;
    joint.name = Unique(name, &names_);
    joint.parent = parent;
    joint.offset = offset;
    if (parent != kNone) skeleton_->joints[static_cast<std::size_t>(parent)].ends = false;
    skeleton_->joints.push_back(joint);
    return static_cast<int>(skeleton_->joints.size()) - 1;
  }

  // A joint that holds the rotation of `point`'s bone, below `joint`, and the point's own joint.
  void Attach(int point, int joint) { AttachTo(point, Add("To" + Name(point), joint, {})); }

  // The bone's rotation is that of `holder`.
  void AttachTo(int point, int holder) {
    skeleton_->joints[static_cast<std::size_t>(holder)].bone = point;
    const Bone& own = bone(point);
    const int joint =
        Add(Name(point), holder,
            {own.rest.x * own.length, own.rest.y * own.length, own.rest.z * own.length});
    const std::vector<int>& next = children_[static_cast<std::size_t>(point)];
    if (next.size() == 1) return AttachTo(next.front(), joint);
    for (const int child : next) Attach(child, joint);
  }

  const Figure& body_;
  Skeleton* skeleton_;
  std::vector<std::vector<int>> children_;
  std::set<std::string> names_;
};

}  // namespace

Vector3 Span(const Skeleton& skeleton, const Figure& body, std::int64_t frame, int bone) {
  // The neck stands at 0, whatever its columns hold.
  const auto at = [&](int point) -> Vector3 {
    if (point == kNone || point == skeleton.neck) return {};
    const auto i = static_cast<std::size_t>(point);
    return {double{body.x(frame, i)} * skeleton.cm, -double{body.y(frame, i)} * skeleton.cm, 0};
  };
  const Vector3 end = at(bone), begin = at(skeleton.bones[static_cast<std::size_t>(bone)].from);
  return {end.x - begin.x, end.y - begin.y, 0};
}

std::vector<Vector3> SpansOf(const Skeleton& skeleton, const Motion& motion) {
  std::vector<Vector3> spans;
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    for (int i = 0; i < std::ssize(skeleton.bones); ++i)
      spans.push_back(skeleton.IsBone(i) ? Span(skeleton, *motion.body, t, i) : Vector3{});
  }
  return spans;
}

Result<Skeleton> MakeSkeleton(const Motion& motion, const FormatOptions& options,
                              LengthQuantile quantile) {
  const Figure& body = *motion.body;
  const auto n = std::ssize(body.points);
  if (n > kMaxPoints)
    return Status(Code::kResourceExhausted, Count(static_cast<std::uint64_t>(n), "point") +
                                                ", expected at most " + Grouped(kMaxPoints) +
                                                " in a skeleton");
  Skeleton skeleton;
  for (int i = 0; i < n && skeleton.neck == kNone; ++i) {
    if (body.points[static_cast<std::size_t>(i)].source == motion::kNeck) skeleton.neck = i;
  }
  skeleton.cm = kShoulderCm / ShoulderOf(motion, options);
  skeleton.neck_cm =
      options.stances.empty() ? skeleton.cm : kShoulderCm / options.stances.front().shoulder;
  const std::vector<int> parents = ParentsOf(body, skeleton.neck);
  skeleton.bones.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    Bone& bone = skeleton.bones[static_cast<std::size_t>(i)];
    bone.from = bone.before = parents[static_cast<std::size_t>(i)];
    if (bone.before == skeleton.neck) bone.before = kNone;
    bone.source = body.points[static_cast<std::size_t>(i)].source;
    bone.rest = RestOf(bone.source);
  }
  for (int i = 0; i < n; ++i) {
    Bone& bone = skeleton.bones[static_cast<std::size_t>(i)];
    if (skeleton.IsBone(i)) bone.length = LengthOf(skeleton, motion, i, quantile(bone));
  }
  JointMaker(body, &skeleton).Make();
  return skeleton;
}

}  // namespace gestus::outputs
