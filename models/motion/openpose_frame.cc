#include "models/motion/openpose_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "models/io/json_reader.h"
#include "models/io/text.h"

namespace gestus::motion {
namespace {

// No camera has as many pixels; what lies outside is damage.
constexpr double kMaxPixel = 1e6;

std::string Found(const Json& value) {
  if (value.is_number()) return Significant(value.get<double>(), 6);
  return std::string("a JSON ") + value.type_name();
}

// The triples of x, y and confidence in `array`; a null makes a point that was not found.
Status ReadPoints(const Json& array, const std::string& field, std::span<Point> points,
                  std::int64_t* nulls) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    double triple[3];
    bool null = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& value = array[3 * p + i];
      null |= value.is_null();
      triple[i] = value.is_number() ? value.get<double>() : 0;
      if (!(value.is_number() || value.is_null()) || !(std::fabs(triple[i]) <= kMaxPixel)) {
        return BadInput(field + "[" + std::to_string(3 * p + i) + "]: " + Found(value) +
                        ", expected a number within 1000000 of 0");
      }
    }
    *nulls += null;
    const bool found = !null && triple[2] > 0 && (triple[0] != 0 || triple[1] != 0);
    if (!found) continue;
    // A confidence may come out a little above 1.
    points[p] = {static_cast<float>(triple[0]), static_cast<float>(triple[1]),
                 static_cast<float>(std::min(triple[2], 1.0))};
  }
  return Status();
}

// One array of key points of a person, under its name of OpenPose 1.2 or of older versions.
struct Field {
  const Json* array = nullptr;  // null when it is absent or empty
  std::string name;
  std::size_t points() const { return array->size() / 3; }
};

Result<Field> FindField(const Json& person, const std::string& where, const std::string& name,
                        std::initializer_list<std::size_t> counts, const std::string& expected) {
  Field field;
  for (const std::string& key : {name + "_2d", name}) {
    field.array = Member(person, key.c_str());
    field.name = where + "." + key;
    if (field.array != nullptr) break;
  }
  if (field.array == nullptr || field.array->is_null()) return Field();
  if (!field.array->is_array()) {
    return BadInput(field.name + ": " + Found(*field.array) + ", expected an array of numbers");
  }
  const std::size_t size = field.array->size();
  if (size == 0) return Field();
  for (const std::size_t count : counts) {
    if (size == 3 * count) return field;
  }
  return BadInput(field.name + ": has " + Count(size, "number") + ", expected " + expected);
}

// False in `*has_body` for someone of whom only a face or hands were looked for.
Status ReadPerson(const Json& json, const std::string& where, Person* person, bool* has_body,
                  std::int64_t* nulls) {
  if (!json.is_object())
    return BadInput(where + ": " + Found(json) + ", expected a person's key points");
  if (Member(json, "pose_keypoints_2d") == nullptr && Member(json, "pose_keypoints") == nullptr) {
    return BadInput(where + ": has no pose_keypoints_2d, expected OpenPose's key points");
  }
  const Result<Field> pose =
      FindField(json, where, "pose_keypoints", {kBody25Points, kCoco18Points},
                "75 (BODY_25), 54 (COCO) or none");
  if (!pose.ok()) return pose.status();
  *has_body = false;
  if (pose->array != nullptr) {
    std::array<Point, kBody25Points> points;
    GESTUS_RETURN_IF_ERROR(
        ReadPoints(*pose->array, pose->name, std::span(points).first(pose->points()), nulls));
    const auto& from = pose->points() == kBody25Points ? kBody25 : kCoco18;
    for (std::size_t j = 0; j < from.size(); ++j) {
      person->body[j] = points[from[j]];
      *has_body |= person->body[j].confidence > 0;
    }
  }
  for (const auto& [name, root] : {std::pair("hand_left_keypoints", kLHandRoot),
                                   std::pair("hand_right_keypoints", kRHandRoot)}) {
    const Result<Field> hand = FindField(json, where, name, {kHandPoints}, "63 or none");
    if (!hand.ok()) return hand.status();
    if (hand->array == nullptr) continue;
    GESTUS_RETURN_IF_ERROR(ReadPoints(*hand->array, hand->name,
                                      std::span(person->body).subspan(root, kHandPoints), nulls));
  }
  const Result<Field> face = FindField(json, where, "face_keypoints", {kFacePoints}, "210 or none");
  if (!face.ok()) return face.status();
  if (face->array == nullptr) return Status();
  return ReadPoints(*face->array, face->name, person->face, nulls);
}

std::span<const Point> Body(const Person& person) {
  return std::span(person.body).first(kBodyJoints);
}

float MeanConfidence(const Person& person) {
  float sum = 0;
  for (const Point& p : Body(person)) sum += p.confidence;
  return sum / static_cast<float>(kBodyJoints);
}

// The larger side of the box around the body.
float Size(const Person& person) {
  constexpr float kFar = std::numeric_limits<float>::max();
  float left = kFar, right = -kFar, top = kFar, bottom = -kFar;
  for (const Point& p : Body(person)) {
    if (p.confidence <= 0) continue;
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  return std::max(right - left, bottom - top);
}

// Mean distance of the joints that both have; of their centres when they have none in common.
float Distance(const Person& a, const Person& b) {
  float sum = 0, common = 0;
  std::array<float, 3> centre_a = {}, centre_b = {};  // x, y, joints
  const auto add = [](const Point& p, std::array<float, 3>* centre) {
    if (p.confidence <= 0) return;
    *centre = {(*centre)[0] + p.x, (*centre)[1] + p.y, (*centre)[2] + 1};
  };
  for (std::size_t j = 0; j < kBodyJoints; ++j) {
    const Point &p = a.body[j], &q = b.body[j];
    add(p, &centre_a);
    add(q, &centre_b);
    if (p.confidence <= 0 || q.confidence <= 0) continue;
    sum += std::hypot(p.x - q.x, p.y - q.y);
    ++common;
  }
  if (common > 0) return sum / common;
  return std::hypot(centre_a[0] / centre_a[2] - centre_b[0] / centre_b[2],
                    centre_a[1] / centre_a[2] - centre_b[1] / centre_b[2]);
}

}  // namespace

Result<OpenPoseFrame> ParseOpenPose(std::string_view text) {
  const Result<Json> json = ParseJson(text);
  if (!json.ok()) return json.status();
  const Json* people = Member(*json, "people");
  if (people == nullptr || !people->is_array()) {
    return BadInput("has no array \"people\", expected a frame of OpenPose");
  }
  OpenPoseFrame frame;
  for (std::size_t i = 0; i < people->size(); ++i) {
    Person person;
    bool has_body = false;
    GESTUS_RETURN_IF_ERROR(ReadPerson((*people)[i], "people[" + std::to_string(i) + "]", &person,
                                      &has_body, &frame.null_points));
    if (has_body) frame.people.push_back(person);
  }
  return frame;
}

const Person* PersonChooser::Choose(const std::vector<Person>& people) {
  ++frames_since_;
  const Person* best = nullptr;
  if (!found_) {
    for (const Person& p : people) {
      if (best == nullptr || MeanConfidence(p) > MeanConfidence(*best)) best = &p;
    }
  } else {
    float nearest = std::numeric_limits<float>::infinity();
    for (const Person& p : people) {
      const float distance = Distance(p, last_);
      const float reach = 0.5f * std::max(Size(p), Size(last_)) * static_cast<float>(frames_since_);
      if (distance > reach || distance >= nearest) continue;
      nearest = distance;
      best = &p;
    }
  }
  if (best == nullptr) return nullptr;
  last_ = *best;
  found_ = true;
  frames_since_ = 0;
  return best;
}

}  // namespace gestus::motion
