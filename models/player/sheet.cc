// Staves of equal length, each with the figures of its time above the sound and the words.
#include "models/player/sheet.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "models/io/text.h"
#include "models/player/drawing.h"
#include "models/player/quantise.h"
#include "models/player/text.h"

namespace gestus::player {
namespace {

constexpr double kWidth = 1180, kMargin = 20, kFigure = 170, kWave = 44, kWords = 26, kGap = 22;
constexpr double kTrail = 0.4;  // seconds
constexpr std::string_view kGround = "#808893";

/// Of middle brightness, for light grounds and dark ones.
std::string_view ColourOf(Ink ink) {
  switch (ink) {
    case Ink::kRight:
      return "#e0703a";
    case Ink::kLeft:
      return "#3f83e0";
    case Ink::kSkin:
      return "none";  // the ground shows through
    case Ink::kCheek:
      return "#e0703a";
    case Ink::kEye:
      return "none";
    case Ink::kBody:
    case Ink::kTorso:
    case Ink::kBrow:
    case Ink::kPupil:
      break;
  }
  return kGround;
}

/// A number for an attribute; one digit is a tenth of a pixel.
std::string At(double value) {
  std::string text = Fixed(value, 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

class Sheet {
 public:
  Sheet(const Show& show, const SheetOptions& options) : show_(show) {
    const double seconds = std::max(show.seconds(), 1e-3);
    const double staves = std::ceil(seconds / options.stave - 1e-9);
    step_ = std::max(options.step, seconds / options.max_figures);
    span_ = std::max(step_, std::ceil(seconds / std::max(staves, 1.0) / step_ - 1e-9) * step_);
    scale_ = (kWidth - 2 * kMargin) / std::max(span_, options.stave / 2);
    for (const Take& take : TakesOf(show)) {
      takes_.push_back({take.role, take.motion->seconds(), TakeDrawing(*take.motion)});
      const BodyDrawing::Extent own = takes_.back().drawing.extent();
      extent_ = takes_.size() == 1 ? own : Join(extent_, own);
    }
    if (!show.sound.samples.empty()) levels_ = LevelsOf(show.sound);
  }

  std::string Render() {
    const double seconds = show_.seconds();
    Text(kMargin, 28, show_.title, 16, "start", 600);
    Text(kMargin, 50, Subtitle(), 14, "start");
    double y = 66;
    for (double begin = 0; begin < seconds - 1e-6; begin += span_) y = AddStave(begin, y);
    const std::string height = At(y), width = At(kWidth);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height +
           "\" width=\"" + width + "\" height=\"" + height +
           "\" font-family=\"system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif\" fill=\"" +
           std::string(kGround) +
           "\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>" +
           Escaped(show_.title) + "</title>\n" + out_ + "</svg>\n";
  }

 private:
  struct Row {
    std::string role;
    double seconds;
    TakeDrawing drawing;
  };

  std::string Subtitle() const {
    std::string text = show_.network.empty() ? "" : show_.network + ", ";
    text += Count(static_cast<std::uint64_t>(show_.prediction.frames), "frame") + " at " +
            At(show_.prediction.frame_rate) + " a second, a figure every " + At(step_) + " s.";
    if (!show_.trained) text += " Untrained weights: the motion is noise.";
    return text;
  }

  double X(double seconds, double begin) const { return kMargin + (seconds - begin) * scale_; }

  /// Draws what lies between `begin` and `begin` + span_; returns where the next one goes.
  double AddStave(double begin, double y) {
    for (const Row& row : takes_) {
      if (takes_.size() > 1) Text(kMargin, y + 12, row.role, 12, "start", 600);
      AddFigures(row, begin, y);
      y += kFigure;
    }
    if (!levels_.peak.empty()) {
      AddWave(begin, y);
      y += kWave;
    }
    if (!show_.words.empty()) {
      AddWords(begin, y + 16);
      y += kWords;
    }
    return y + kGap;
  }

  void AddFigures(const Row& row, double begin, double y) {
    const double width = step_ * scale_;
    for (int i = 0; i < static_cast<int>(std::lround(span_ / step_)); ++i) {
      const double at = begin + (i + 0.5) * step_;
      if (at >= row.seconds && !(i == 0 && begin == 0)) break;
      const Placement place =
          Fit(extent_, X(begin + i * step_, begin) - 0.03 * width, y, 1.06 * width, kFigure);
      for (const Shape& shape : row.drawing.At(at, kTrail)) AddShape(shape, place);
    }
  }

  void AddShape(const Shape& shape, const Placement& place) {
    const std::string_view colour = ColourOf(shape.ink);
    if (colour == "none") return;
    const std::string opacity =
        shape.opacity < 1
            ? " opacity=\"" + Fixed(shape.opacity * (shape.ink == Ink::kTorso ? 0.35 : 1), 2) + "\""
            : "";
    const double width = std::max(shape.width * place.scale, 1.0);
    if (shape.kind == Shape::Kind::kDisc) {
      const Vec2 centre = place(shape.points[0]);
      out_ += "<circle cx=\"" + At(centre.x) + "\" cy=\"" + At(centre.y) + "\" r=\"" + At(width) +
              "\" fill=\"" + std::string(colour) + "\"" + opacity + "/>\n";
      return;
    }
    std::string points;
    for (const Vec2 point : shape.points) {
      const Vec2 at = place(point);
      points += (points.empty() ? "" : " ") + At(at.x) + "," + At(at.y);
    }
    if (shape.kind == Shape::Kind::kArea) {
      out_ += "<polygon points=\"" + points + "\" fill=\"" + std::string(colour) + "\"" + opacity +
              "/>\n";
      return;
    }
    out_ += "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" + std::string(colour) +
            "\" stroke-width=\"" + At(width) + "\"" + opacity + "/>\n";
  }

  /// The peaks above and below a line, half as many points as pixels.
  void AddWave(double begin, double y) {
    const double loudest =
        std::max<double>(16, *std::max_element(levels_.peak.begin(), levels_.peak.end()));
    const double middle = y + kWave / 2, reach = (kWave / 2 - 3) / loudest;
    const auto first = static_cast<std::size_t>(std::max(0.0, begin * Levels::kRate));
    const auto end =
        std::min(levels_.peak.size(), static_cast<std::size_t>((begin + span_) * Levels::kRate));
    const auto each = static_cast<std::size_t>(std::max(1.0, 2 * Levels::kRate / scale_));
    std::string upper, lower;
    for (std::size_t i = first; i < end; i += each) {
      const auto most = *std::max_element(
          levels_.peak.begin() + static_cast<std::ptrdiff_t>(i),
          levels_.peak.begin() + static_cast<std::ptrdiff_t>(std::min(i + each, end)));
      const std::string x = At(X((static_cast<double>(i) + 0.5) / Levels::kRate, begin));
      const double high = std::max(most * reach, 0.4);
      upper += x + "," + At(middle - high) + " ";
      lower.insert(0, x + "," + At(middle + high) + " ");
    }
    if (!upper.empty())
      out_ += "<polygon points=\"" + upper + lower + "\" fill=\"#21968f\" opacity=\"0.75\"/>\n";
  }

  void AddWords(double begin, double y) {
    double free = 0;
    for (const words::Word& word : show_.words) {
      const double middle = (word.start + word.end) / 2;
      if (!(middle >= begin && middle < begin + span_)) continue;
      // Short words in a row would overlap: each waits for the one before it.
      const double letters =
          static_cast<double>(std::count_if(word.text.begin(), word.text.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
          }));
      const double half = 3.9 * letters + 2;
      const double x = std::min(std::max(X(middle, begin), free + half), kWidth - half);
      free = x + half;
      Text(x, y, word.text, 14, "middle");
    }
  }

  void Text(double x, double y, std::string_view text, int size, const char* anchor,
            int weight = 400) {
    out_ += "<text x=\"" + At(x) + "\" y=\"" + At(y) + "\" font-size=\"" + std::to_string(size) +
            "\"" + (weight == 400 ? "" : " font-weight=\"" + std::to_string(weight) + "\"") +
            (std::string_view(anchor) == "start" ? ""
                                                 : " text-anchor=\"" + std::string(anchor) + "\"") +
            ">" + Escaped(text) + "</text>\n";
  }

  const Show& show_;
  double step_ = 0, span_ = 0, scale_ = 0;
  std::vector<Row> takes_;
  BodyDrawing::Extent extent_;
  Levels levels_;
  std::string out_;
};

}  // namespace

Result<std::string> MakeSheet(const Show& show, const SheetOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckShow(show));
  if (!(options.step > 0) || !(options.stave > 0) || options.max_figures < 1)
    return Status(Code::kInvalidArgument, "contact sheet: a step or stave of nothing");
  return Sheet(show, options).Render();
}

}  // namespace gestus::player
