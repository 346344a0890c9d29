// What the writers of single formats share.  A private header of formats.cc and theirs: motions
// that come here have been checked, and have what their format needs.
#ifndef GESTUS_MODELS_OUTPUTS_WRITERS_H_
#define GESTUS_MODELS_OUTPUTS_WRITERS_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "engine/status.h"
#include "models/io/file.h"
#include "models/outputs/formats.h"

namespace gestus::outputs {

class FaceCurves;

Status WriteOpenPose(const Motion& motion, const std::string& path, const FormatOptions& options);
Status WriteOpenFace(const Motion& motion, const std::string& path, const FormatOptions& options,
                     bool with_keys);
Status WriteCsv(const Motion& motion, const std::string& path);
Status WriteBvh(const Motion& motion, const std::string& path, const FormatOptions& options,
                bool lifted);
Status WriteArkit(const Motion& motion, const std::string& path);
Status WriteVrm(const Motion& motion, const std::string& path);
Status WriteVrma(const Motion& motion, const std::string& path);
Status WriteFap(const Motion& motion, const std::string& path, const FormatOptions& options);
Status WriteBap(const Motion& motion, const std::string& path, const FormatOptions& options);

/// Whether there is an action unit that moves a FAP.
bool HasFap(const FaceCurves& face);

/// Appends `value` with `digits` after the point, never "-0.00", whatever the locale.
void AppendFixed(std::string* text, double value, int digits);
/// Appends the fewest digits that read back as the same float.
void AppendExact(std::string* text, float value);
/// The same of a double.
std::string Exact(double value);

/// "wave" of "out/wave.bvh", or the option's name; blanks and control characters become "_".
std::string ClipName(const std::string& path, const FormatOptions& options);

/// A text file in the making; nobody sees it before Commit().
class TextFile {
 public:
  static Result<TextFile> Create(const std::string& path);
  Status Add(std::string_view text);
  Status Commit();

 private:
  explicit TextFile(AtomicFile&& file) : file_(std::move(file)) {}
  Status Flush();

  AtomicFile file_;
  std::string buffer_;
};

}  // namespace gestus::outputs

#endif  // GESTUS_MODELS_OUTPUTS_WRITERS_H_
