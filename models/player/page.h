// A page that plays motion beside its recording: one file, no network, opened by any browser.
//
//   Show show;
//   show.title = "speech.wav";
//   show.prediction = *outputs::MotionOf(record, outputs);
//   Result<std::string> page = MakePage(show, &notes);   // the bytes of the .html file
#ifndef GESTUS_MODELS_PLAYER_PAGE_H_
#define GESTUS_MODELS_PLAYER_PAGE_H_

#include <string>
#include <vector>

#include "engine/status.h"
#include "models/player/show.h"

namespace gestus::player {

/// A WAV file of this size or less is embedded as it is when every browser plays it; otherwise the
/// samples are, 16 bits each.
inline constexpr std::size_t kMaxPlainWav = std::size_t{8} << 20;
/// A longer recording is shown without its sound: browsers hold no larger one in a page.
inline constexpr double kMaxSoundSeconds = 3600;

/// The whole page.  Coordinates in it are within 0.25 of the motion's, those beyond +-16000
/// excepted. `notes` gets what a user should know, a line each.  Errors: those of CheckShow().
Result<std::string> MakePage(const Show& show, std::vector<std::string>* notes);

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_PAGE_H_
