#include "models/player/pictures.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"

namespace gestus::player {
namespace {

constexpr Colour kPage = {0xf4, 0xf3, 0xef}, kGround = {0xff, 0xff, 0xff},
                 kMuted = {0x6c, 0x73, 0x7d}, kInk = {0x23, 0x28, 0x2f},
                 kAccent = {0x0f, 0x7c, 0x74}, kWave = {0xa9, 0xc8, 0xc4},
                 kWarn = {0x9a, 0x5b, 0x00};
constexpr double kTrail = 0.6;  // seconds
// Of a picture 720 high.
constexpr double kMargin = 16, kTop = 16, kPanelBottom = 592, kWaveTop = 606, kWaveBottom = 666,
                 kFootline = 703, kLetters = 15;

Colour ColourOf(Ink ink) {
  switch (ink) {
    case Ink::kBody:
      return {0x4a, 0x53, 0x5e};
    case Ink::kRight:
      return {0xd8, 0x63, 0x2c};
    case Ink::kLeft:
      return {0x2f, 0x6f, 0xcf};
    case Ink::kTorso:
      return {0xcf, 0xd6, 0xdd};
    case Ink::kSkin:
      return {0xfb, 0xf1, 0xe6};
    case Ink::kBrow:
      return {0x35, 0x3c, 0x45};
    case Ink::kCheek:
      return {0xe9, 0x92, 0x7a};
    case Ink::kEye:
      return kGround;
    case Ink::kPupil:
      break;
  }
  return {0x3a, 0x43, 0x4d};
}

}  // namespace

Pictures::Pictures(const Show& show, int width, int height)
    : show_(show),
      width_(width),
      height_(height),
      unit_(height / 720.0),
      still_(width, height, kPage),
      raster_(width, height, kPage) {
  const std::vector<Take> takes = TakesOf(show);
  const auto count = static_cast<double>(takes.size());
  const double room = (width_ / unit_ - kMargin) / count;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    panels_.push_back({takes[i].role, TakeDrawing(*takes[i].motion),
                       kMargin + static_cast<double>(i) * room, room - kMargin});
    const BodyDrawing::Extent own = panels_.back().drawing.extent();
    extent_ = i == 0 ? own : Join(extent_, own);
  }
  if (!show.sound.samples.empty()) levels_ = LevelsOf(show.sound);
  DrawStill();
}

// What is the same in all pictures.
void Pictures::DrawStill() {
  for (const Panel& panel : panels_) {
    const double left = panel.left * unit_, right = left + panel.width * unit_;
    const double top = kTop * unit_, bottom = kPanelBottom * unit_, round = 12 * unit_;
    const Vec2 corners[4] = {{left + round, top + round},
                             {right - round, top + round},
                             {right - round, bottom - round},
                             {left + round, bottom - round}};
    still_.Area(corners, kGround);
    const Vec2 rim[5] = {corners[0], corners[1], corners[2], corners[3], corners[0]};
    still_.Line(rim, 2 * round, kGround);
    if (panels_.size() > 1)
      still_.Text({left + 16 * unit_, top + 34 * unit_}, kLetters * unit_, panel.role, kMuted);
  }
  DrawWave(-1);
  if (!show_.trained) {
    const std::string text = "untrained weights";
    const double letters = kLetters * unit_;
    still_.Text({width_ - kMargin * unit_ - TextWidth(letters, text), kFootline * unit_}, letters,
                text, kWarn);
  }
}

const Raster& Pictures::At(double time) {
  raster_ = still_;
  for (const Panel& panel : panels_) DrawPanel(panel, time);
  DrawWave(time);
  const double letters = kLetters * unit_;
  raster_.Text({kMargin * unit_, kFootline * unit_}, letters,
               Fixed(time, 1) + " / " + Fixed(show_.seconds(), 1), kInk);
  return raster_;
}

void Pictures::DrawPanel(const Panel& panel, double time) {
  const double head = panels_.size() > 1 ? 48 : 24;
  const Placement place = Fit(extent_, panel.left * unit_, (kTop + head) * unit_,
                              panel.width * unit_, (kPanelBottom - kTop - head - 16) * unit_);
  std::vector<Vec2> points;
  for (const Shape& shape : panel.drawing.At(time, kTrail)) {
    points.clear();
    for (const Vec2 point : shape.points) points.push_back(place(point));
    const Colour colour = ColourOf(shape.ink);
    switch (shape.kind) {
      case Shape::Kind::kLine:
        raster_.Line(points, shape.width * place.scale, colour, shape.opacity);
        break;
      case Shape::Kind::kArea:
        raster_.Area(points, colour, shape.opacity);
        break;
      case Shape::Kind::kDisc:
        raster_.Disc(points[0], shape.width * place.scale, colour, shape.opacity);
        break;
    }
  }
}

/// The sound, that before `time` in another colour, and the line at `time`; below 0 all of it.
void Pictures::DrawWave(double time) {
  Raster* raster = time < 0 ? &still_ : &raster_;
  const double left = kMargin * unit_, right = width_ - kMargin * unit_;
  const double middle = (kWaveTop + kWaveBottom) / 2 * unit_;
  const double seconds = std::max(show_.seconds(), 1e-6);
  const auto x = [&](double at) { return left + at / seconds * (right - left); };
  const double step = 3 * unit_;
  const double loudest =
      levels_.peak.empty()
          ? 1
          : std::max<double>(16, *std::max_element(levels_.peak.begin(), levels_.peak.end()));
  for (double bar = left; bar < (time < 0 ? right : x(time)); bar += step) {
    double most = 0;
    const auto level = [&](double at) {
      return static_cast<std::size_t>(
          std::max(0.0, (at - left) / (right - left) * seconds * Levels::kRate));
    };
    for (std::size_t i = level(bar);
         i < std::min(levels_.peak.size(), std::max(level(bar + step), level(bar) + 1)); ++i)
      most = std::max<double>(most, levels_.peak[i]);
    const double reach =
        std::max(most / loudest * (kWaveBottom - kWaveTop) / 2 * unit_, 0.8 * unit_);
    const Vec2 ends[2] = {{bar, middle - reach}, {bar, middle + reach}};
    raster->Line(ends, 1.8 * unit_, time < 0 ? kWave : kAccent);
  }
  if (time < 0) return;
  const Vec2 hand[2] = {{x(time), kWaveTop * unit_}, {x(time), kWaveBottom * unit_}};
  raster->Line(hand, 3 * unit_, kInk);
}

}  // namespace gestus::player
