// Runs the audio front end on behalf of the tests in Python.  Each line of standard input is a
// command with its arguments between tabs:
//
//   read FILE OUT             a sound file to mono float32
//   head FILE OUT             only opens it
//   log_mel_512 IN OUT RATE   the others take mono float32 and write rows of float32
//   log_mel_400 IN OUT
//   fbank IN OUT MEAN
//   resample IN OUT FROM TO
//
// The answer is one line: "ok", after `read` and `head` with rate, channels, frames and the notes
// between tabs, or "error: <sentence>".  The last line is the largest resident size in KiB.  OUT
// may be
// "-".
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "models/audio/fbank.h"
#include "models/audio/log_mel.h"
#include "models/audio/resampler.h"
#include "models/audio/rows.h"
#include "models/audio/source.h"
#include "models/io/reading.h"
#include "models/io/text.h"

namespace {

using gestus::Code;
using gestus::Result;
using gestus::Status;
namespace audio = gestus::audio;

void Write(std::ofstream& out, const float* values, std::size_t n) {
  out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(n * sizeof(float)));
}

double Number(const std::vector<std::string>& fields, std::size_t i) {
  double value = 0;
  if (i < fields.size()) (void)gestus::ParseNumber(fields[i], &value);
  return value;
}

// Reads in pieces and keeps none of them, so that memory stays flat.
Result<std::string> Read(const std::string& path, const std::string& to, bool head) {
  auto source = audio::OpenAudio(path);
  if (!source.ok()) return source.status();
  std::ofstream out;
  if (to != "-") out.open(to, std::ios::binary);
  std::vector<float> piece(10007);
  while (!head) {
    const Result<std::size_t> got = (*source)->Read(piece.data(), piece.size());
    if (!got.ok()) return got.status();
    if (*got == 0) break;
    Write(out, piece.data(), *got);
  }
  std::ostringstream answer;
  answer << "\t" << (*source)->sample_rate() << "\t" << (*source)->channels() << "\t"
         << (*source)->frames();
  for (const std::string& note : (*source)->notes()) answer << "\t" << gestus::OneLine(note);
  return answer.str();
}

template <class Stage>
Status Run(Result<Stage> stage, const std::vector<std::string>& fields) {
  if (!stage.ok()) return stage.status();
  std::ifstream in(fields[1], std::ios::binary | std::ios::ate);
  std::vector<float> samples(static_cast<std::size_t>(in.tellg()) / sizeof(float));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(samples.data()),
          static_cast<std::streamsize>(samples.size() * sizeof(float)));
  const std::vector<float> rows = audio::AllRows(&*stage, samples.data(), samples.size());
  std::ofstream out(fields[2], std::ios::binary);
  Write(out, rows.data(), rows.size());
  return out.good() ? Status() : Status(Code::kIo, "cannot write " + fields[2]);
}

Result<std::string> Do(const std::vector<std::string>& fields) {
  const auto integer = [&](std::size_t i) { return static_cast<int>(Number(fields, i)); };
  Status status(Code::kInvalidArgument, "unknown command");
  if (fields.size() < 3) return status;
  if (fields[0] == "read") return Read(fields[1], fields[2], false);
  if (fields[0] == "head") return Read(fields[1], fields[2], true);
  if (fields[0] == "log_mel_512")
    status = Run(audio::LogMel::Make(audio::PatsLogMel512(integer(3))), fields);
  if (fields[0] == "log_mel_400") status = Run(audio::LogMel::Make(audio::PatsLogMel400()), fields);
  if (fields[0] == "fbank")
    status = Run(audio::Fbank::Make({.mean = static_cast<float>(Number(fields, 3))}), fields);
  if (fields[0] == "resample") status = Run(audio::Resampler::Make(integer(3), integer(4)), fields);
  if (!status.ok()) return status;
  return std::string();
}

}  // namespace

int main() {
  std::string line;
  while (std::getline(std::cin, line)) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, '\t');) fields.push_back(field);
    const Result<std::string> answer = Do(fields);
    std::puts(answer.ok() ? ("ok" + *answer).c_str()
                          : ("error: " + gestus::OneLine(answer.status().message())).c_str());
  }
  // The peak of this process: ru_maxrss would begin with that of the process that forked.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    status >> word;
    std::puts(word.c_str());
  }
  return 0;
}
