// A video, drawn by a small rasteriser of our own and encoded by the program ffmpeg.
#ifndef GESTUS_MODELS_PLAYER_VIDEO_H_
#define GESTUS_MODELS_PLAYER_VIDEO_H_

#include <string>

#include "engine/status.h"
#include "models/player/show.h"

namespace gestus::player {

struct VideoOptions {
  int width = 1280, height = 720;  ///< pixels, even
  double rate = 30;                ///< pictures a second
};

/// Whether the program ffmpeg can be run; the error says what to install.
Status FindFfmpeg();

/// The bytes of an MP4 file with H.264, and AAC where there is sound.  ffmpeg is found on the PATH
/// and run without a shell.  Errors: those of CheckShow(); no ffmpeg; what ffmpeg says.
Result<std::string> MakeVideo(const Show& show, const VideoOptions& options = {});

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_VIDEO_H_
