// Key points that OpenPose found in a video, as PATS' joints and OpenPose's 70 face points.
//
//   Result<OpenPoseClip> clip = ReadOpenPose("speaker/", {.frame_rate = 29.97});
#ifndef GESTUS_MODELS_MOTION_OPENPOSE_H_
#define GESTUS_MODELS_MOTION_OPENPOSE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/motion/clip.h"

namespace gestus::motion {

struct OpenPoseOptions {
  double frame_rate = 15;  ///< of the video: OpenPose does not store it
  std::int64_t max_frames = kMaxFrames;
  std::uint64_t max_file_bytes = 4'000'000;  ///< of one frame's file
};

struct OpenPoseClip {
  Track body;  ///< PATS' 52 joints, pixels; confidence 0 where nothing was found
  Track face;  ///< 70 points; without frames when no frame has a face
  std::vector<std::string> notes;
};

/// Reads a folder with one file a frame, or the file of a single frame (`write_json` of
/// OpenPose 1.0 and later; BODY_25 or COCO; face and hands may be missing).
///
/// In a folder the files are those named *<frame number>_keypoints.json, all with the same name
/// before the number; other files are left out.  Numbers that are missing are frames in which
/// nothing was found, and so are frames without people.  Of several people the one is followed
/// whose body was found with the highest mean confidence in the first frame with people; in later
/// frames it is whoever is nearest to where that one was last, but nobody further away than half
/// the figure's size for each frame since then.  A hand root that no frame has is taken from the
/// wrist.
///
/// Errors: no such files, a file that is no frame of OpenPose (its name, field, what was found and
/// expected), too many frames, nobody in any frame.
Result<OpenPoseClip> ReadOpenPose(const std::string& path, const OpenPoseOptions& options = {});

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_OPENPOSE_H_
