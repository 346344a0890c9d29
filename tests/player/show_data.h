// Small shows for the tests of models/player.
#ifndef GESTUS_TESTS_PLAYER_SHOW_DATA_H_
#define GESTUS_TESTS_PLAYER_SHOW_DATA_H_

#include "models/player/show.h"

namespace gestus::player::test {

/// Four points of a body that move, 15 frames a second.
Show BodyShow(std::int64_t frames);
/// AU01, AU04 and Rx, 24 frames a second.
Show HeadShow(std::int64_t frames);
/// A tone of so many seconds at 8 kHz.
Sound Tone(double seconds);

}  // namespace gestus::player::test

#endif  // GESTUS_TESTS_PLAYER_SHOW_DATA_H_
