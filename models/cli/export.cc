#include "models/cli/export.h"

#include <filesystem>
#include <set>

#include "models/cli/finish.h"
#include "models/cli/json.h"
#include "models/cli/npz.h"
#include "models/cli/setup.h"
#include "models/io/text.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;
using outputs::Motion;

Status Bad(const std::string& what) { return Status(Code::kInvalidArgument, what); }

Result<Arrays> ReadMotion(const std::string& path) {
  std::vector<models::ArraySpec> wanted;
  for (const char* name : {"pose", "face", "lengths", "times_ms", kFrameRate}) {
    models::ArraySpec spec;
    spec.name = name;
    spec.required = false;
    if (wanted.size() == 2 || wanted.size() == 3) spec.dtype = DType::kI32;
    wanted.push_back(spec);
  }
  Result<NpzContents> file = ReadNpz(path, wanted);
  if (!file.ok()) return file.status();
  if (file->arrays.count("pose") == 0 && file->arrays.count("face") == 0)
    return Status(Code::kBadInput,
                  path + ": has no pose and no face, expected the output of a run");
  return std::move(file->arrays);
}

/// The motion in `arrays`, also of finished ones: at a rate of their own, curves as (frames,
/// curves).
Result<Motion> MotionOf(const fb::Network& record, Arrays arrays) {
  double rate = 0;
  GESTUS_RETURN_IF_ERROR(TakeFinished(&arrays, &rate));
  if (rate == 0) return outputs::MotionOf(record, arrays);
  Result<Motion> motion = outputs::MotionOf(record, arrays, {.frame_rate = rate});
  if (motion.ok()) motion->frame_rate = rate;
  return motion;
}

/// The motion by the network that is named, or by the only one whose output it can be.
Result<Motion> FindMotion(const Arguments& arguments, const WeightsFile& weights,
                          const Arrays& arrays) {
  if (!arguments.network.empty() && weights.FindNetwork(arguments.network) == nullptr)
    return Status(Code::kNotFound, weights.path() + ": no network " + arguments.network +
                                       ", expected one of infer-cli info");
  std::vector<Result<Motion>> found;
  Status failed;
  for (const fb::Network* record : *weights.root().networks()) {
    if (!arguments.network.empty() && record->name()->str() != arguments.network) continue;
    Result<Motion> motion = MotionOf(*record, arrays);
    if (motion.ok()) {
      found.push_back(std::move(motion));
    } else {
      failed = motion.status();
    }
  }
  if (found.size() == 1) return std::move(found.front());
  if (found.empty()) return failed.In(arguments.Input());
  return Bad(weights.path() + ": several networks make such motion, expected --network NAME");
}

Status CheckFormats(const Motion& motion, const Exports& exports) {
  for (const Exports::File& file : exports.files)
    GESTUS_RETURN_IF_ERROR(outputs::Suits(motion, file.format).In(file.path));
  return Status();
}

/// "a/b" of "./a//c/../b/".
std::string Plain(const std::string& path) {
  std::string plain = std::filesystem::path(path).lexically_normal().string();
  if (plain.size() > 1 && plain.back() == '/') plain.pop_back();
  return plain;
}

/// The last of two outputs of one path would be all that is left, and an input would be lost.
Status CheckPaths(const Arguments& arguments, const Exports& exports) {
  std::vector<std::string> paths = {arguments.output, arguments.html, arguments.svg, arguments.mp4};
  for (const Exports::File& file : exports.files) paths.push_back(file.path);
  std::set<std::string> seen, inputs = {Plain(arguments.weights)};
  for (const std::string& path : arguments.inputs) inputs.insert(Plain(path));
  for (const std::string* path :
       {&arguments.words, &arguments.style, &arguments.source, &arguments.target})
    inputs.insert(Plain(*path));
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    // Arrays may be replaced by what was made of them.
    if (path != arguments.output && inputs.count(Plain(path)) > 0)
      return Bad(path + ": an input and an output, expected another path for the output");
    if (!seen.insert(Plain(path)).second)
      return Bad(path + ": named for two outputs, expected a path for each");
  }
  return Status();
}

}  // namespace

std::vector<std::string> Exports::Lines() const {
  std::vector<std::string> lines;
  for (const File& file : files) lines.push_back(outputs::NameOf(file.format) + ": " + file.path);
  return lines;
}

Result<Exports> ParseExports(const Arguments& arguments) {
  Exports exports;
  for (const std::string& text : arguments.exports) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      return Bad("command line: --export " + text + ", expected FORMAT=PATH");
    const Result<outputs::Format> format = outputs::FormatOf(text.substr(0, equals));
    if (!format.ok()) return format.status().In("command line: --export");
    exports.files.push_back({*format, text.substr(equals + 1)});
  }
  GESTUS_RETURN_IF_ERROR(CheckPaths(arguments, exports));
  exports.options.halve = arguments.halve;
  const std::vector<float>& stance = arguments.stance;
  if (stance.size() == 3) exports.options.stances = {{stance[0], stance[1], stance[2]}};
  return exports;
}

Status CheckExports(const fb::Network& record, const Exports& exports) {
  if (exports.files.empty()) return Status();
  const Result<Motion> layout = outputs::LayoutOf(record);
  if (!layout.ok()) return layout.status();
  return CheckFormats(*layout, exports);
}

Status WriteExports(const Motion& motion, const Exports& exports) {
  GESTUS_RETURN_IF_ERROR(CheckFormats(motion, exports));
  for (const Exports::File& file : exports.files)
    GESTUS_RETURN_IF_ERROR(WriteMotion(motion, file.format, file.path, exports.options));
  return Status();
}

Status RunExport(const Arguments& arguments) {
  const Result<Exports> exports = ParseExports(arguments);
  if (!exports.ok()) return exports.status();
  const Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(arguments.weights);
  if (!weights.ok()) return weights.status();
  const Result<Arrays> arrays = ReadMotion(arguments.inputs.front());
  if (!arrays.ok()) return arrays.status();
  const Result<Motion> motion = FindMotion(arguments, **weights, *arrays);
  if (!motion.ok()) return motion.status();
  GESTUS_RETURN_IF_ERROR(WriteExports(*motion, *exports));
  if (arguments.json) {
    JsonWriter json;
    json.BeginObject()
        .Member("input", arguments.Input())
        .Member("frames", static_cast<std::uint64_t>(motion->frames))
        .Member("frame_rate", motion->frame_rate)
        .Member("exports", exports->Lines())
        .EndObject();
    return Print(json.text());
  }
  std::string text = "read   " + arguments.Input() + ": " + Significant(motion->seconds(), 3) +
                     " s at " + Significant(motion->frame_rate, 3) + " frames/s\n";
  for (const std::string& line : exports->Lines()) text += "wrote  " + line + "\n";
  return Print(text);
}

}  // namespace gestus::cli
