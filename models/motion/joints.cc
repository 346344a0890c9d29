#include "models/motion/joints.h"

namespace gestus::motion {

std::vector<std::string> PatsJointNames() {
  std::vector<std::string> names = {"Neck",   "RShoulder", "RElbow", "RWrist", "LShoulder",
                                    "LElbow", "LWrist",    "Nose",   "REye",   "LEye"};
  for (const char* side : {"L", "R"}) {
    names.push_back(std::string(side) + "HandRoot");
    for (const char* finger : {"Thumb", "Index", "Middle", "Ring", "Little"}) {
      for (int joint = 1; joint <= 4; ++joint) {
        names.push_back(std::string(side) + "Hand" + finger + std::to_string(joint));
      }
    }
  }
  return names;
}

std::vector<std::string> FacePointNames() {
  std::vector<std::string> names;
  for (std::int64_t i = 0; i < kFacePoints; ++i) names.push_back("Face" + std::to_string(i));
  return names;
}

}  // namespace gestus::motion
