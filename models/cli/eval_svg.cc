#include "models/cli/eval_svg.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"

namespace gestus::cli {
namespace {

constexpr double kWidth = 760, kHeight = 260, kLeft = 56, kRight = 12, kTop = 30, kBottom = 44;
constexpr double kPlotWidth = kWidth - kLeft - kRight, kPlotHeight = kHeight - kTop - kBottom;

std::string N(double value) { return Fixed(value, 1); }

std::string TextAt(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + N(x) + "\" y=\"" + N(y) + "\" text-anchor=\"" + anchor + "\">" +
         Escaped(text) + "</text>";
}

/// A distance of about `count` ticks in `range`: 1, 2 or 5 times a power of ten.
double Step(double range, double count) {
  const double power = std::pow(10.0, std::floor(std::log10(range / count)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * count >= range) return factor * power;
  }
  return 10 * power;
}

/// A tick's value with as many digits as the step between ticks needs.
std::string Label(double value, double step) {
  if (std::abs(value) >= 1e7) return Significant(value, 3);
  return Fixed(value, std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9));
}

/// Heights of values between the lowest and the highest tick.
class Axis {
 public:
  Axis(double low, double high) {
    constexpr double kTicks = 5;
    // A constant still needs a range, and so does what is one but for rounding.
    if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))) {
      const double around = std::max(std::abs(high), 1e-6);
      low -= around / 2;
      high += around / 2;
    }
    step_ = Step(high - low, kTicks);
    // 100 but for rounding needs no tick above it.
    low_ = std::floor(low / step_ + 1e-9);
    high_ = std::ceil(high / step_ - 1e-9);
  }

  double At(double value) const {
    return kTop + kPlotHeight * (1 - (value / step_ - low_) / (high_ - low_));
  }

  std::string Ticks(const std::string& unit) const {
    std::string svg;
    for (double tick = low_; tick <= high_; ++tick) {
      const double y = At(tick * step_);
      svg += "<path class=\"grid\" d=\"M" + N(kLeft) + " " + N(y) + "H" + N(kWidth - kRight) +
             "\"/>" + TextAt(kLeft - 6, y + 4, "end", Label(tick * step_, step_));
    }
    return svg + TextAt(4, 12, "start", unit);
  }

 private:
  double step_ = 1, low_ = 0, high_ = 1;  // low_ and high_ in steps
};

std::string Begin(const std::string& caption) {
  return "<figure><figcaption>" + Escaped(caption) + "</figcaption>\n<svg viewBox=\"0 0 " +
         N(kWidth) + " " + N(kHeight) + "\" role=\"img\" aria-label=\"" + Escaped(caption) +
         "\">\n";
}

template <class Series>
std::string End(const std::vector<Series>& series) {
  std::string html = "</svg>\n<p class=\"legend\">";
  for (const Series& one : series)
    html += "<span><i class=\"" + one.color + "\"></i>" + Escaped(one.name) + "</span>";
  return html + "</p></figure>\n";
}

std::string Bar(double x, double width, const Axis& axis, const Bars& bars, std::size_t i,
                bool labels) {
  const metrics::Measure& value = bars.values[i];
  if (!value) return TextAt(x + width / 2, axis.At(0) - 4, "middle", "–");
  const double top = std::min(axis.At(*value), axis.At(0));
  const double height = std::abs(axis.At(*value) - axis.At(0));
  std::string svg = "<rect class=\"" + bars.color + "\" x=\"" + N(x) + "\" y=\"" + N(top) +
                    "\" width=\"" + N(width) + "\" height=\"" + N(height) + "\"><title>" +
                    Escaped(bars.name + ": " + Significant(*value, 4)) + "</title></rect>";
  if (labels) svg += TextAt(x + width / 2, top - 4, "middle", Significant(*value, 3));
  return svg + "\n";
}

}  // namespace

std::string Escaped(const std::string& text) {
  std::string html;
  for (const char c : OneLine(text, std::string::npos)) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string BarChart(const std::string& caption, const std::string& unit,
                     const std::vector<std::string>& categories, const std::vector<Bars>& bars,
                     const metrics::Measure& line) {
  constexpr std::size_t kMostLabels = 21;
  constexpr double kGap = 0.25;  // of a category's width
  double low = 0, high = line.value_or(0);
  for (const Bars& one : bars) {
    for (const metrics::Measure& value : one.values) {
      low = std::min(low, value.value_or(0));
      high = std::max(high, value.value_or(0));
    }
  }
  const Axis axis(low, high > low ? high : low + 1);
  std::string svg = Begin(caption) + axis.Ticks(unit);
  const double whole = kPlotWidth / static_cast<double>(categories.size());
  const double width = whole * (1 - kGap) / static_cast<double>(bars.size());
  const bool labels = categories.size() * bars.size() <= kMostLabels;
  for (std::size_t i = 0; i < categories.size(); ++i) {
    const double begin = kLeft + whole * static_cast<double>(i);
    double x = begin + whole * kGap / 2;
    for (const Bars& one : bars) {
      svg += Bar(x, width * 0.95, axis, one, i, labels);
      x += width;
    }
    svg += TextAt(begin + whole / 2, kHeight - kBottom + 18, "middle", categories[i]);
  }
  if (line)
    svg += "<path class=\"line\" d=\"M" + N(kLeft) + " " + N(axis.At(*line)) + "H" +
           N(kWidth - kRight) + "\"/>\n";
  svg += "<path class=\"axis\" d=\"M" + N(kLeft) + " " + N(axis.At(0)) + "H" + N(kWidth - kRight) +
         "\"/>\n";
  return svg + End(bars);
}

std::string LineChart(const std::string& caption, const std::string& unit, double rate,
                      const std::vector<Line>& lines) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  std::size_t longest = 2;
  for (const Line& line : lines) {
    for (const double value : line.values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
    longest = std::max(longest, line.values.size());
  }
  if (low > high) return "";
  const Axis axis(low, high);
  const double seconds = static_cast<double>(longest - 1) / rate;
  std::string svg = Begin(caption) + axis.Ticks(unit);
  const double step = Step(seconds, 8);
  for (double tick = 0; tick * step <= seconds * (1 + 1e-9); ++tick)
    svg += TextAt(kLeft + kPlotWidth * tick * step / seconds, kHeight - kBottom + 18, "middle",
                  Label(tick * step, step) + " s");
  for (const Line& line : lines) {
    if (line.values.empty()) continue;
    svg += "<polyline class=\"" + line.color + "\" points=\"";
    for (std::size_t i = 0; i < line.values.size(); ++i)
      svg += N(kLeft + kPlotWidth * static_cast<double>(i) / static_cast<double>(longest - 1)) +
             "," + N(axis.At(line.values[i])) + " ";
    svg += "\"/>\n";
  }
  return svg + End(lines);
}

}  // namespace gestus::cli
