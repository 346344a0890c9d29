// VRM Animation: a binary glTF (.vrma) whose nodes stand for the bones and expressions of any VRM
// model.  VRM's axes are BVH's (x the model's left, y up, z forwards), and so is the T of its rest
// pose.
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "models/outputs/blendshapes.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/lift.h"
#include "models/outputs/poser.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little endian");

/// The bones that every VRM model has, at rest: where each begins, from its parent, in m.
struct HumanBone {
  const char* name;
  int parent;
  Vector3 place;
};
constexpr std::array<HumanBone, 15> kBones = {{{"hips", kNone, {0, 0.95, 0}},
                                               {"spine", 0, {0, 0.1, 0}},
                                               {"head", 1, {0, 0.5, 0}},
                                               {"leftUpperArm", 1, {0.18, 0.4, 0}},
                                               {"leftLowerArm", 3, {0.27, 0, 0}},
                                               {"leftHand", 4, {0.25, 0, 0}},
                                               {"rightUpperArm", 1, {-0.18, 0.4, 0}},
                                               {"rightLowerArm", 6, {-0.27, 0, 0}},
                                               {"rightHand", 7, {-0.25, 0, 0}},
                                               {"leftUpperLeg", 0, {0.09, -0.05, 0}},
                                               {"leftLowerLeg", 9, {0, -0.4, 0}},
                                               {"leftFoot", 10, {0, -0.4, 0}},
                                               {"rightUpperLeg", 0, {-0.09, -0.05, 0}},
                                               {"rightLowerLeg", 12, {0, -0.4, 0}},
                                               {"rightFoot", 13, {0, -0.4, 0}}}};
constexpr int kHead = 2;

/// Which point of PATS a humanoid bone leads to: elbows, wrists, the nose.
constexpr std::array<std::pair<int, std::int64_t>, 5> kPointed = {
    {{3, 5}, {4, 6}, {6, 2}, {7, 3}, {kHead, 7}}};

/// A node's values over time.
struct Track {
  int node = 0;
  bool rotates = true;        ///< else its place holds the weight of an expression
  std::vector<float> values;  ///< 4 or 3 a frame
};

void AppendRotation(const Quaternion& q, Track* track) {
  const std::vector<float>& v = track->values;
  const std::size_t n = v.size();
  // The same rotation on the side of the last one, or players would turn the long way round.
  const bool flip = n >= 4 && double{v[n - 4]} * q.x + double{v[n - 3]} * q.y +
                                      double{v[n - 2]} * q.z + double{v[n - 1]} * q.w <
                                  0;
  for (const double value : {q.x, q.y, q.z, q.w})
    track->values.push_back(static_cast<float>(flip ? -value : value));
}

/// Arms, and the head where no angles say how it turns.
Status AddBody(const Motion& motion, bool with_head, std::vector<Track>* tracks) {
  const Result<Skeleton> skeleton = MakeSkeleton(motion, {}, LiftedQuantile);
  if (!skeleton.ok()) return skeleton.status();
  struct Source {
    int point;  // whose bone turns the humanoid bone
    int above;  // the point whose bone turns the parent; kNone: nothing does
    Track track;
  };
  std::vector<Source> sources;
  const auto point_of = [&](std::int64_t source) {
    for (int i = 0; i < std::ssize(skeleton->bones); ++i) {
      if (skeleton->IsBone(i) && skeleton->bones[static_cast<std::size_t>(i)].source == source)
        return i;
    }
    return kNone;
  };
  for (const auto& [bone, source] : kPointed) {
    const int point = point_of(source);
    if (point == kNone || (bone == kHead && !with_head)) continue;
    const bool fore = bone == 4 || bone == 7;
    sources.push_back({point, fore ? point_of(source - 1) : kNone, {bone, true, {}}});
  }
  std::vector<Vector3> spans = SpansOf(*skeleton, motion);
  Lift(*skeleton, motion.frames, &spans);
  Poser poser(*skeleton, true);
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    poser.Next(&spans[static_cast<std::size_t>(t) * skeleton->bones.size()]);
    for (Source& s : sources) {
      const Quaternion& own = poser.world()[static_cast<std::size_t>(s.point)];
      AppendRotation(s.above == kNone
                         ? own
                         : Product(Inverse(poser.world()[static_cast<std::size_t>(s.above)]), own),
                     &s.track);
    }
  }
  for (Source& s : sources) tracks->push_back(std::move(s.track));
  return Status();
}

/// The head, and a node for each expression behind those of the bones.
void AddFace(const Motion& motion, const FaceCurves& face, std::vector<Track>* tracks,
             std::vector<std::string>* expressions) {
  if (face.HasHead()) {
    Track head{kHead, true, {}};
    for (std::int64_t t = 0; t < motion.frames; ++t) AppendRotation(HeadRotation(face, t), &head);
    tracks->push_back(std::move(head));
  }
  for (const Blendshape& shape : kBlendshapes) {
    if (shape.unit == 0 || !face.HasUnit(shape.unit)) continue;
    Track track{static_cast<int>(kBones.size() + expressions->size()), false, {}};
    for (std::int64_t t = 0; t < motion.frames; ++t) {
      track.values.push_back(static_cast<float>(face.Weight(t, shape.unit)));
      track.values.insert(track.values.end(), 2, 0.0f);
    }
    tracks->push_back(std::move(track));
    expressions->emplace_back(shape.name);
  }
}

// A list of the JSON that grows by whole items.
void Append(std::string* list, const std::string& item) {
  *list += (list->empty() ? "" : ",") + item;
}

std::string Triple(const Vector3& v) {
  return "[" + Exact(v.x) + "," + Exact(v.y) + "," + Exact(v.z) + "]";
}

/// Nodes, their meaning and the root nodes.
std::string NodesJson(const std::vector<std::string>& expressions) {
  std::string nodes, bones, custom, roots = "0";
  for (int i = 0; i < std::ssize(kBones); ++i) {
    const HumanBone& bone = kBones[static_cast<std::size_t>(i)];
    std::string children;
    for (int j = 0; j < std::ssize(kBones); ++j) {
      if (kBones[static_cast<std::size_t>(j)].parent == i) Append(&children, std::to_string(j));
    }
    if (!children.empty()) children = ",\"children\":[" + children + "]";
    const std::string name = "\"" + std::string(bone.name) + "\"";
    Append(&nodes, "{\"name\":" + name + ",\"translation\":" + Triple(bone.place) + children + "}");
    Append(&bones, name + ":{\"node\":" + std::to_string(i) + "}");
  }
  for (std::size_t i = 0; i < expressions.size(); ++i) {
    const std::string name = "\"" + expressions[i] + "\"";
    const std::string node = std::to_string(kBones.size() + i);
    Append(&nodes, "{\"name\":" + name + "}");
    Append(&custom, name + ":{\"node\":" + node + "}");
    Append(&roots, node);
  }
  return "\"scene\":0,\"scenes\":[{\"nodes\":[" + roots + "]}],\"nodes\":[" + nodes +
         "],\"extensions\":{\"VRMC_vrm_animation\":{\"specVersion\":\"1.0\",\"humanoid\":{"
         "\"humanBones\":{" +
         bones + "}},\"expressions\":{\"custom\":{" + custom + "}}}}";
}

/// One animation; accessor 0 is the time, accessor n + 1 track n, each with a view of its own.
std::string AnimationJson(const Motion& motion, const std::vector<Track>& tracks, float last_time) {
  const auto frames = static_cast<std::size_t>(motion.frames);
  const std::string count = std::to_string(frames);
  std::string channels, samplers, accessors, views;
  std::size_t offset = 0, made = 0;
  const auto add = [&](const std::string& type, std::size_t floats, const std::string& more) {
    Append(&accessors, "{\"bufferView\":" + std::to_string(made++) +
                           ",\"componentType\":5126,\"count\":" + count + ",\"type\":\"" + type +
                           "\"" + more + "}");
    Append(&views, "{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) +
                       ",\"byteLength\":" + std::to_string(4 * floats) + "}");
    offset += 4 * floats;
  };
  add("SCALAR", frames, ",\"min\":[0],\"max\":[" + Exact(double{last_time}) + "]");
  for (std::size_t n = 0; n < tracks.size(); ++n) {
    const std::string path = tracks[n].rotates ? "rotation" : "translation";
    Append(&channels, "{\"sampler\":" + std::to_string(n) + ",\"target\":{\"node\":" +
                          std::to_string(tracks[n].node) + ",\"path\":\"" + path + "\"}}");
    Append(&samplers,
           "{\"input\":0,\"interpolation\":\"LINEAR\",\"output\":" + std::to_string(n + 1) + "}");
    add(tracks[n].rotates ? "VEC4" : "VEC3", tracks[n].values.size(), "");
  }
  return "\"animations\":[{\"name\":\"gestus\",\"channels\":[" + channels + "],\"samplers\":[" +
         samplers + "]}],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
         "],\"buffers\":[{\"byteLength\":" + std::to_string(offset) + "}]";
}

void AppendBytes(std::string* bytes, const void* data, std::size_t size) {
  bytes->append(static_cast<const char*>(data), size);
}

void AppendWord(std::string* bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  AppendBytes(bytes, &word, sizeof word);
}

}  // namespace

Status WriteVrma(const Motion& motion, const std::string& path) {
  const FaceCurves face(motion);
  const bool has_face = face.HasUnits() || face.HasHead();
  std::vector<Track> tracks;
  std::vector<std::string> expressions;
  if (motion.body) GESTUS_RETURN_IF_ERROR(AddBody(motion, !face.HasHead(), &tracks));
  if (has_face) AddFace(motion, face, &tracks, &expressions);

  std::vector<float> times;
  for (std::int64_t t = 0; t < motion.frames; ++t)
    times.push_back(static_cast<float>(static_cast<double>(t) / motion.frame_rate));
  std::string json =
      "{\"asset\":{\"version\":\"2.0\",\"generator\":\"gestus\"},"
      "\"extensionsUsed\":[\"VRMC_vrm_animation\"]," +
      NodesJson(expressions) + "," + AnimationJson(motion, tracks, times.back()) + "}";
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string binary;
  AppendBytes(&binary, times.data(), times.size() * sizeof(float));
  for (const Track& track : tracks)
    AppendBytes(&binary, track.values.data(), track.values.size() * sizeof(float));
  std::string head = "glTF";
  constexpr std::size_t kHeads = 12 + 8 + 8;
  if (kHeads + json.size() + binary.size() > UINT32_MAX)
    return Status(Code::kResourceExhausted, "more than 4 GB, expected a shorter motion");
  AppendWord(&head, 2);
  AppendWord(&head, kHeads + json.size() + binary.size());
  AppendWord(&head, json.size());
  head += "JSON" + json;
  AppendWord(&head, binary.size());
  head += std::string("BIN\0", 4);
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(file->Add(head));
  GESTUS_RETURN_IF_ERROR(file->Add(binary));
  return file->Commit();
}

}  // namespace gestus::outputs
