#include "models/styles/gallery.h"

#include <array>
#include <charconv>

#include "models/io/json_reader.h"
#include "models/styles/distance.h"
#include "models/styles/gallery_page.h"
#include "models/styles/map.h"

namespace gestus::styles {
namespace {

constexpr std::size_t kMostStyles = 300;
// Fewer have hardly any neighbours that a map could tell apart.
constexpr std::size_t kFewForNeighbours = 10;

/// `x` to seven digits: a page needs no more, and is half as long.
double Short(double x) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 7);
  std::from_chars(text.data(), end.ptr, x);
  return x;
}

Json PointsJson(const Points& points) {
  Json json = Json::array();
  for (const auto& [x, y] : points) json.push_back({Short(x), Short(y)});
  return json;
}

Json PartJson(const std::vector<Named>& styles, const Part& part) {
  const Rows rows = RowsOf(styles, part);
  const PrincipalMap components = MapByComponents(rows);
  Json json = {{"name", part.name},
               {"width", part.width},
               {"components", PointsJson(components.points)},
               {"explained", {Short(components.explained[0]), Short(components.explained[1])}},
               {"neighbours", nullptr}};
  if (rows.size() > kFewForNeighbours) {
    const NeighbourMap map = MapByNeighbours(rows);
    json["neighbours"] = PointsJson(map.points);
    json["perplexity"] = Short(map.perplexity);
    json["divergence"] = Short(map.divergence);
  }
  for (const auto& x : rows) {
    Json cosine = Json::array(), euclidean = Json::array();
    for (const auto& y : rows) {
      const std::optional<double> distance = CosineDistance(x, y);
      cosine.push_back(distance.has_value() ? Json(Short(*distance)) : Json());
      euclidean.push_back(Short(EuclideanDistance(x, y)));
    }
    json["cosine"].push_back(std::move(cosine));
    json["euclidean"].push_back(std::move(euclidean));
    json["norms"].push_back(Short(Norm(x)));
  }
  return json;
}

Json SourcesJson(const Style& style) {
  Json json = Json::array();
  for (const Source& source : style.made_of)
    json.push_back({{"name", source.name}, {"share", source.share}, {"segments", source.segments}});
  return json;
}

/// Text of `json` that ends no element of HTML; bytes that are not UTF-8 become U+FFFD.
std::string ForPage(const Json& json) {
  const std::string text =
      json.dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

Result<std::string> MakeGallery(const std::vector<Named>& styles, const GalleryOptions& options) {
  if (styles.size() < 2 || styles.size() > kMostStyles)
    return Status(Code::kInvalidArgument, "gallery: " + std::to_string(styles.size()) +
                                              " styles, expected 2 to " +
                                              std::to_string(kMostStyles));
  GESTUS_RETURN_IF_ERROR(CheckAlike(styles));
  Json json = {{"weights", options.weights},
               {"checksum", ChecksumText(styles.front().style.weights_checksum)},
               {"trained", options.trained.has_value() ? Json(*options.trained) : Json()}};
  for (const Named& named : styles) {
    json["names"].push_back(named.name);
    json["made_of"].push_back(SourcesJson(named.style));
  }
  for (const Part& part : WholeAndParts(styles)) json["parts"].push_back(PartJson(styles, part));
  return kGalleryHead + ForPage(json) + kGalleryTail;
}

}  // namespace gestus::styles
