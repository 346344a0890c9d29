// Action units and head rotation that OpenFace found in a video.
//
//   Result<OpenFaceClip> clip = ReadOpenFace("speaker.csv");
#ifndef GESTUS_MODELS_MOTION_OPENFACE_H_
#define GESTUS_MODELS_MOTION_OPENFACE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/motion/clip.h"

namespace gestus::motion {

struct OpenFaceOptions {
  /// Columns that must be there; if none are named, those of AUnn_r and pose_Rx, _Ry, _Rz that are.
  std::vector<std::string> columns = {};
  double frame_rate =
      24;  ///< for files whose timestamps do not tell it; the thesis' videos have 24
  std::int64_t max_frames = kMaxFrames;
  std::int64_t max_rows = 4 * kMaxFrames;  ///< of all faces together
};

struct OpenFaceClip {
  /// A point of one coordinate for each column, by its name: AUnn_r 0 to 5, pose_R* in rad.
  /// Confidence is OpenFace's, and 0 where success is 0, a cell is no number, or the frame or the
  /// face is missing.  Values are kept as they stand in the file, also where confidence is 0.
  Track track;
  std::vector<std::string> notes;
};

/// Reads the CSV of OpenFace 0.2 to 2.2: columns by name, blanks around names and cells allowed,
/// face_id, confidence, success, frame and timestamp optional.  Numbers that `frame` leaves out are
/// frames in which no face was found.  Of several faces the one is taken that is found in most
/// frames (of equals the lowest face_id).
///
/// The frame rate is that of the timestamps; one of 15, 23.976, 24, 25, 29.97, 30, 50, 59.94 and
/// 60 is taken where the timestamps, rounded to milliseconds, fit it.
///
/// Errors: no such column, a cell that is no number, a row of another length than the header, frame
/// numbers that go back, too many frames, no face in any frame; with line and column.
Result<OpenFaceClip> ReadOpenFace(const std::string& path, const OpenFaceOptions& options = {});

}  // namespace gestus::motion

#endif  // GESTUS_MODELS_MOTION_OPENFACE_H_
