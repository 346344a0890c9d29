// The pictures of a video, one at any time.  A private header of models/player.
#ifndef GESTUS_MODELS_PLAYER_PICTURES_H_
#define GESTUS_MODELS_PLAYER_PICTURES_H_

#include <string>
#include <vector>

#include "models/player/drawing.h"
#include "models/player/quantise.h"
#include "models/player/raster.h"
#include "models/player/show.h"

namespace gestus::player {

/// Takes side by side above the sound and a line at the time shown.
class Pictures {
 public:
  /// `show` must outlive this.
  Pictures(const Show& show, int width, int height);

  /// Valid until the next call.
  const Raster& At(double time);

 private:
  struct Panel {
    std::string role;
    TakeDrawing drawing;
    double left = 0, width = 0;
  };

  void DrawStill();
  void DrawPanel(const Panel& panel, double time);
  void DrawWave(double time);

  const Show& show_;
  int width_, height_;
  double unit_;  // what sizes are measured in: 1 in a picture 720 high
  std::vector<Panel> panels_;
  BodyDrawing::Extent extent_;
  Levels levels_;
  Raster still_, raster_;
};

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_PICTURES_H_
