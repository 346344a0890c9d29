// ARKit's 52 blendshapes in the order of Live Link Face's CSV, and the action unit (FACS) that each
// stands for.  A private header of the writers.
#ifndef GESTUS_MODELS_OUTPUTS_BLENDSHAPES_H_
#define GESTUS_MODELS_OUTPUTS_BLENDSHAPES_H_

#include <array>

namespace gestus::outputs {

struct Blendshape {
  const char* name;  ///< ARKit's; Live Link Face begins it with a capital
  int unit = 0;      ///< 0: none that OpenFace measures
};

inline constexpr std::array<Blendshape, 52> kBlendshapes = {{
    {"eyeBlinkLeft", 45},
    {"eyeLookDownLeft"},
    {"eyeLookInLeft"},
    {"eyeLookOutLeft"},
    {"eyeLookUpLeft"},
    {"eyeSquintLeft", 7},
    {"eyeWideLeft", 5},
    {"eyeBlinkRight", 45},
    {"eyeLookDownRight"},
    {"eyeLookInRight"},
    {"eyeLookOutRight"},
    {"eyeLookUpRight"},
    {"eyeSquintRight", 7},
    {"eyeWideRight", 5},
    {"jawForward"},
    {"jawRight"},
    {"jawLeft"},
    {"jawOpen", 26},
    {"mouthClose"},
    {"mouthFunnel"},
    {"mouthPucker"},
    {"mouthRight"},
    {"mouthLeft"},
    {"mouthSmileLeft", 12},
    {"mouthSmileRight", 12},
    {"mouthFrownLeft", 15},
    {"mouthFrownRight", 15},
    {"mouthDimpleLeft", 14},
    {"mouthDimpleRight", 14},
    {"mouthStretchLeft", 20},
    {"mouthStretchRight", 20},
    {"mouthRollLower"},
    {"mouthRollUpper"},
    {"mouthShrugLower", 17},
    {"mouthShrugUpper"},
    {"mouthPressLeft"},
    {"mouthPressRight"},
    {"mouthLowerDownLeft"},
    {"mouthLowerDownRight"},
    {"mouthUpperUpLeft", 10},
    {"mouthUpperUpRight", 10},
    {"browDownLeft", 4},
    {"browDownRight", 4},
    {"browInnerUp", 1},
    {"browOuterUpLeft", 2},
    {"browOuterUpRight", 2},
    {"cheekPuff"},
    {"cheekSquintLeft", 6},
    {"cheekSquintRight", 6},
    {"noseSneerLeft", 9},
    {"noseSneerRight", 9},
    {"tongueOut"},
}};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_BLENDSHAPES_H_
