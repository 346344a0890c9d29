#include "models/cli/style_commands.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "engine/weights_file.h"
#include "models/cli/inputs.h"
#include "models/cli/json.h"
#include "models/cli/setup.h"
#include "models/cli/style_file.h"
#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/styles/blend.h"
#include "models/styles/distance.h"
#include "models/styles/gallery.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using styles::Named;
using styles::Part;

/// Styles, and the weights that made them where these were given.
struct Collection {
  std::vector<Named> styles;
  std::shared_ptr<const WeightsFile> weights;
};

/// Adds the parts that a file does not tell of: those of the network of its weights that makes
/// styles of as many values.
Status AddParts(const WeightsFile& weights, const std::string& path, styles::Style* style) {
  if (style->weights_checksum != weights.checksum())
    return Status(Code::kBadInput,
                  path + ": weights_checksum: made by other weights, expected " + weights.path());
  if (!style->parts.empty()) return Status();
  for (const fb::Network* network : *weights.root().networks()) {
    Result<std::vector<Part>> parts = styles::PartsOf(*network);
    if (!parts.ok()) continue;
    std::int64_t width = 0;
    for (const Part& part : *parts) width += part.width;
    if (width == static_cast<std::int64_t>(style->values.size())) style->parts = *std::move(parts);
  }
  if (!style->parts.empty()) return Status();
  return Status(Code::kBadInput, path + ": style: " + std::to_string(style->values.size()) +
                                     " values, expected those of a network of " + weights.path());
}

/// "anna" of "styles/anna.style"; the whole path where that is the name of two.
void NameStyles(const std::vector<std::string>& paths, std::vector<Named>* styles) {
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    std::string name = LastPart(path);
    if (name.ends_with(".style") && name.size() > 6) name.resize(name.size() - 6);
    names.push_back(name);
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool once = std::count(names.begin(), names.end(), names[i]) == 1;
    (*styles)[i].name = once ? names[i] : paths[i];
  }
}

Result<Collection> Collect(const Arguments& arguments) {
  Collection collection;
  std::vector<std::string> paths;
  for (const std::string& path : arguments.inputs) {
    const Result<InputKind> kind = Recognise(path);
    if (!kind.ok()) return kind.status();
    if (*kind != InputKind::kWeights) {
      paths.push_back(path);
      continue;
    }
    if (collection.weights != nullptr)
      return Status(Code::kInvalidArgument, path + ": a second weights file, expected one");
    Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(path);
    if (!weights.ok()) return weights.status();
    collection.weights = *std::move(weights);
  }
  if (paths.empty())
    return Status(Code::kInvalidArgument, "styles: none, expected a .style file at least");
  for (const std::string& path : paths) {
    Result<styles::Style> style = ReadStyleFile(path);
    if (!style.ok()) return style.status();
    if (collection.weights != nullptr)
      GESTUS_RETURN_IF_ERROR(AddParts(*collection.weights, path, &*style));
    collection.styles.push_back({path, *std::move(style)});
  }
  return collection;
}

/// The same of styles that belong together, with short names.
Result<Collection> CollectAlike(const Arguments& arguments, std::size_t least) {
  Result<Collection> collection = Collect(arguments);
  if (!collection.ok()) return collection;
  std::vector<Named>& all = collection->styles;
  if (all.size() < least)
    return Status(Code::kInvalidArgument, "styles: " + std::to_string(all.size()) + ", expected " +
                                              std::to_string(least) + " at least");
  GESTUS_RETURN_IF_ERROR(styles::CheckAlike(all));
  std::vector<std::string> paths;
  for (const Named& named : all) paths.push_back(named.name);
  NameStyles(paths, &all);
  return collection;
}

std::string SourceText(const styles::Source& source) {
  std::string text = Fixed(100 * source.share, 1) + " % " + OneLine(source.name);
  if (source.segments > 0)
    text += ", " + Count(static_cast<std::uint64_t>(source.segments), "segment");
  return text;
}

std::string InfoText(const Named& named, const Collection& collection) {
  const styles::Style& style = named.style;
  std::string text = OneLine(named.name) + "\n";
  std::vector<std::vector<std::string>> rows = {
      {"weights",
       styles::ChecksumText(style.weights_checksum) +
           (collection.weights == nullptr ? ""
                                          : ", those of " + OneLine(collection.weights->path()))},
      {"network", style.network.empty() ? "not known" : OneLine(style.network)},
      {"values", Grouped(style.values.size())},
      {"norm", Significant(styles::Norm(style.values), 6)}};
  for (const Part& part : style.parts)
    rows.push_back({part.name, Grouped(static_cast<std::uint64_t>(part.width)) + " values, norm " +
                                   Significant(styles::Norm(styles::ValuesOf(style, part)), 6)});
  for (std::size_t i = 0; i < style.made_of.size(); ++i)
    rows.push_back({i == 0 ? "made of" : "", SourceText(style.made_of[i])});
  if (style.made_of.empty()) rows.push_back({"made of", "not known"});
  return text + Table(rows);
}

void InfoJson(const Named& named, JsonWriter* json) {
  const styles::Style& style = named.style;
  json->BeginObject()
      .Member("file", named.name)
      .Member("weights_checksum", styles::ChecksumText(style.weights_checksum))
      .Member("network", style.network)
      .Member("values", static_cast<std::uint64_t>(style.values.size()))
      .Member("norm", styles::Norm(style.values));
  json->Key("parts").BeginArray();
  for (const Part& part : style.parts)
    json->BeginObject()
        .Member("name", part.name)
        .Member("begin", part.begin)
        .Member("width", part.width)
        .Member("norm", styles::Norm(styles::ValuesOf(style, part)))
        .EndObject();
  json->EndArray().Key("made_of").BeginArray();
  for (const styles::Source& source : style.made_of)
    json->BeginObject()
        .Member("name", source.name)
        .Member("share", source.share)
        .Member("segments", source.segments)
        .EndObject();
  json->EndArray().EndObject();
}

/// "a.style:0.7" -> the path and 0.7; without a number behind the last colon all is the path, and
/// the weight is 1.
styles::Ingredient ParseIngredient(const std::string& text, bool* weighted) {
  styles::Ingredient ingredient;
  const std::size_t colon = text.rfind(':');
  const bool number = colon != std::string::npos && colon > 0 &&
                      ParseNumber(std::string_view(text).substr(colon + 1), &ingredient.weight);
  ingredient.from.name = number ? text.substr(0, colon) : text;
  *weighted = *weighted || number;
  return ingredient;
}

using Distance = std::optional<double> (*)(std::span<const float>, std::span<const float>);

std::optional<double> Euclidean(std::span<const float> x, std::span<const float> y) {
  return styles::EuclideanDistance(x, y);
}

std::string DistanceTable(const Collection& collection, const styles::Rows& rows,
                          Distance distance) {
  std::vector<std::vector<std::string>> cells = {{""}};
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    cells[0].push_back(OneLine(collection.styles[i].name, 40));
    cells.push_back({cells[0].back()});
    for (const auto& other : rows) {
      const std::optional<double> value = distance(rows[i], other);
      cells.back().push_back(value.has_value() ? Fixed(*value, 4) : "-");
    }
    numbers.push_back(i + 1);
  }
  return Table(cells, numbers);
}

void DistanceJson(const char* name, const styles::Rows& rows, Distance distance, JsonWriter* json) {
  json->Key(name).BeginArray();
  for (const auto& x : rows) {
    json->BeginArray();
    for (const auto& y : rows)
      json->Value(distance(x, y).value_or(std::numeric_limits<double>::quiet_NaN()));
    json->EndArray();
  }
  json->EndArray();
}

}  // namespace

Status RunStyleInfo(const Arguments& arguments) {
  const Result<Collection> collection = Collect(arguments);
  if (!collection.ok()) return collection.status();
  JsonWriter json;
  std::string text;
  json.BeginArray();
  for (const Named& named : collection->styles) {
    InfoJson(named, &json);
    text += InfoText(named, *collection);
  }
  json.EndArray();
  return Print(arguments.json ? json.text() : text);
}

Status RunStyleBlend(const Arguments& arguments) {
  bool weighted = false;
  std::vector<styles::Ingredient> ingredients;
  for (const std::string& input : arguments.inputs) {
    styles::Ingredient ingredient = ParseIngredient(input, &weighted);
    Result<styles::Style> style = ReadStyleFile(ingredient.from.name);
    if (!style.ok()) return style.status();
    ingredient.from.style = *std::move(style);
    ingredients.push_back(std::move(ingredient));
  }
  if (!weighted)
    for (styles::Ingredient& i : ingredients)
      i.weight = 1.0 / static_cast<double>(ingredients.size());
  for (styles::Ingredient& ingredient : ingredients) {
    // A style whose clips are not known is called by its own name in what is made of it.
    if (ingredient.from.style.made_of.empty())
      ingredient.from.style.made_of = {{LastPart(ingredient.from.name), 1, 0}};
  }
  const Result<styles::Blend> blend = styles::MakeBlend(ingredients);
  if (!blend.ok()) return blend.status();
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);
  GESTUS_RETURN_IF_ERROR(WriteStyleFile(blend->style, arguments.output, &*file));
  if (arguments.json) {
    JsonWriter json;
    json.BeginObject().Member("output", arguments.output).Key("style");
    InfoJson({arguments.output, blend->style}, &json);
    json.Member("notes", blend->notes).EndObject();
    return Print(json.text());
  }
  std::string text = InfoText({arguments.output, blend->style}, {});
  for (const std::string& note : blend->notes) text += "note: " + note + "\n";
  return Print(text);
}

Status RunStyleDistance(const Arguments& arguments) {
  const Result<Collection> collection = CollectAlike(arguments, 2);
  if (!collection.ok()) return collection.status();
  JsonWriter json;
  std::string text;
  json.BeginObject().Key("names").BeginArray();
  for (const Named& named : collection->styles) json.Value(named.name);
  json.EndArray().Key("parts").BeginArray();
  for (const Part& part : styles::WholeAndParts(collection->styles)) {
    const styles::Rows rows = styles::RowsOf(collection->styles, part);
    json.BeginObject().Member("name", part.name).Member("width", part.width);
    DistanceJson("cosine", rows, styles::CosineDistance, &json);
    DistanceJson("euclidean", rows, Euclidean, &json);
    json.EndObject();
    const std::string name = part.name == "style" ? "whole style" : part.name;
    text += name + ", cosine distance\n" +
            DistanceTable(*collection, rows, styles::CosineDistance) + name +
            ", Euclidean distance\n" + DistanceTable(*collection, rows, Euclidean);
  }
  json.EndArray().EndObject();
  return Print(arguments.json ? json.text() : text);
}

Status RunStyleGallery(const Arguments& arguments) {
  const Result<Collection> collection = CollectAlike(arguments, 2);
  if (!collection.ok()) return collection.status();
  styles::GalleryOptions options;
  if (collection->weights != nullptr) {
    options.weights = LastPart(collection->weights->path());
    options.trained = collection->weights->root().provenance()->trained();
  }
  const Result<std::string> page = styles::MakeGallery(collection->styles, options);
  if (!page.ok()) return page.status();
  Result<AtomicFile> file = AtomicFile::Create(arguments.output);
  if (!file.ok()) return file.status().In(arguments.output);
  GESTUS_RETURN_IF_ERROR(file->Write(page->data(), page->size()).In(arguments.output));
  GESTUS_RETURN_IF_ERROR(file->Commit().In(arguments.output));
  if (arguments.json) {
    JsonWriter json;
    json.BeginObject().Member("output", arguments.output);
    json.Member("styles", static_cast<std::uint64_t>(collection->styles.size())).EndObject();
    return Print(json.text());
  }
  return Print(arguments.output + ": a page with " + Count(collection->styles.size(), "style") +
               ", open it in a browser\n");
}

}  // namespace gestus::cli
