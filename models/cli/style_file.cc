#include "models/cli/style_file.h"

#include <algorithm>

#include "models/cli/npz.h"

namespace gestus::cli {
namespace {

// Of all arrays: far more than any network's style and its clips.
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 28;

}  // namespace

Result<bool> IsStyleFile(const std::string& path) {
  const Result<std::vector<std::string>> names = ListNpz(path);
  if (!names.ok()) return names.status();
  return std::find(names->begin(), names->end(), "weights_checksum") != names->end();
}

Result<styles::Style> ReadStyleFile(const std::string& path) {
  NpzLimits limits;
  limits.max_bytes = kMaxBytes;
  const Result<NpzContents> file = ReadNpz(path, styles::StyleSpecs(), limits);
  if (!file.ok()) return file.status();
  Result<styles::Style> style = styles::StyleOf(file->arrays);
  if (!style.ok()) return style.status().In(path);
  return style;
}

Status WriteStyleFile(const styles::Style& style, const std::string& path, AtomicFile* file) {
  GESTUS_RETURN_IF_ERROR(WriteNpz(styles::ArraysOf(style), file).In(path));
  return file->Commit().In(path);
}

std::string LastPart(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos || path.size() == 1 ? path : path.substr(slash + 1);
}

}  // namespace gestus::cli
