#include "tests/player/show_data.h"

#include <cmath>

namespace gestus::player::test {

Show BodyShow(std::int64_t frames) {
  Show show;
  show.title = "speech.wav";
  show.network = "ZS-MSTM 1.0";
  show.prediction.frames = frames;
  outputs::Figure& body = show.prediction.body.emplace();
  body.points = {{"Neck", -1, 0}, {"RShoulder", 0, 1}, {"RWrist", 1, 3}, {"Nose", 0, 7}};
  for (std::int64_t i = 0; i < frames; ++i) {
    const float wave = std::sin(0.3f * static_cast<float>(i));
    for (const float value :
         {640.0f, -166.0f, -95.0f + 40 * wave, 3.0f, 280.0f, 14.0f, 335.0f - 90 * wave, -135.0f})
      body.values.push_back(value);
  }
  return show;
}

Show HeadShow(std::int64_t frames) {
  Show show;
  show.title = "speech.wav";
  show.network = "Model 1";
  show.prediction.frame_rate = 24;
  show.prediction.frames = frames;
  outputs::Curves& curves = show.prediction.curves.emplace();
  curves.curves = {{"AU01", "intensity 0 to 5", 0, 5},
                   {"AU04", "intensity 0 to 5", 0, 5},
                   {"Rx", "rad", -0.6f, 0.6f}};
  for (std::int64_t i = 0; i < frames; ++i) {
    const float wave = std::sin(0.3f * static_cast<float>(i));
    for (const float value : {2.5f + 2 * wave, 0.0f, 0.3f * wave}) curves.values.push_back(value);
  }
  return show;
}

Sound Tone(double seconds) {
  Sound sound;
  sound.sample_rate = 8000;
  for (int i = 0; i < static_cast<int>(8000 * seconds); ++i)
    sound.samples.push_back(0.5f * std::sin(0.3f * static_cast<float>(i)));
  return sound;
}

}  // namespace gestus::player::test
