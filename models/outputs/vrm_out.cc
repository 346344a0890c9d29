// VRM 1.0 for players that set weights frame by frame: expressions by ARKit's names and the head as
// a rotation of its bone.
#include <string>
#include <utility>
#include <vector>

#include "models/outputs/blendshapes.h"
#include "models/outputs/face_curves.h"
#include "models/outputs/writers.h"

namespace gestus::outputs {
namespace {

constexpr int kVrmDigits = 6;

}  // namespace

Status WriteVrm(const Motion& motion, const std::string& path) {
  const FaceCurves face(motion);
  std::vector<const Blendshape*> shapes;
  std::string text = "{\"format\":\"gestus-vrm\",\"specVersion\":\"1.0\",\"frameRate\":";
  text += Exact(motion.frame_rate) + ",\"frames\":" + std::to_string(motion.frames) +
          ",\n\"expressions\":[";
  for (const Blendshape& shape : kBlendshapes) {
    if (shape.unit == 0 || !face.HasUnit(shape.unit)) continue;
    text += (shapes.empty() ? "\"" : ",\"") + std::string(shape.name) + "\"";
    shapes.push_back(&shape);
  }
  Result<TextFile> file = TextFile::Create(path);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(file->Add(text + "],\n\"weights\":["));
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    std::string row = t == 0 ? "\n[" : ",\n[";
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (i > 0) row += ',';
      AppendFixed(&row, face.Weight(t, shapes[i]->unit), kVrmDigits);
    }
    GESTUS_RETURN_IF_ERROR(file->Add(row + "]"));
  }
  GESTUS_RETURN_IF_ERROR(file->Add("],\n\"head\":["));
  for (std::int64_t t = 0; t < motion.frames; ++t) {
    const Quaternion q = HeadRotation(face, t);
    std::string row = t == 0 ? "\n[" : ",\n[";
    for (const double value : {q.x, q.y, q.z, q.w}) {
      if (row.back() != '[') row += ',';
      AppendFixed(&row, value, kVrmDigits);
    }
    GESTUS_RETURN_IF_ERROR(file->Add(row + "]"));
  }
  GESTUS_RETURN_IF_ERROR(file->Add("]}\n"));
  return file->Commit();
}

}  // namespace gestus::outputs
