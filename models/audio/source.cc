#include "models/audio/source.h"

#include <cstring>
#include <utility>

#include "models/audio/wav.h"
#include "models/io/file.h"
#include "models/io/text.h"
#ifdef GESTUS_HAVE_SNDFILE
#include "models/audio/sndfile.h"
#endif

namespace gestus::audio {
namespace {

#ifdef GESTUS_HAVE_SNDFILE
constexpr bool kHaveSndfile = true;
#else
constexpr bool kHaveSndfile = false;

Result<std::unique_ptr<AudioSource>> OpenSndfile(const std::string& path, InputFile) {
  return Status(Code::kBadInput, path + ": cannot be read by this build, which has no libsndfile");
}
#endif

// What the first bytes of a file that is no WAV say it is, for the message of a build that reads
// nothing else.
std::string KindOf(const std::uint8_t* bytes, std::size_t n) {
  struct Kind {
    const char* magic;
    const char* name;
  };
  constexpr Kind kKinds[] = {{"fLaC", "a FLAC file"},  {"OggS", "an Ogg file"},
                             {"ID3", "an MP3 file"},   {"\xFF\xFB", "an MP3 file"},
                             {"FORM", "an AIFF file"}, {"caff", "a CAF file"},
                             {".snd", "an AU file"},   {"RIFX", "a big-endian WAV file"}};
  for (const Kind& kind : kKinds) {
    const std::size_t size = std::strlen(kind.magic);
    if (n >= size && std::memcmp(bytes, kind.magic, size) == 0) return kind.name;
  }
  return "no WAV file";
}

}  // namespace

void AudioSource::NoteNotFinite(std::uint64_t count) {
  if (not_finite_ == 0) {
    not_finite_note_ = notes_.size();
    notes_.emplace_back();
  }
  not_finite_ += count;
  notes_[not_finite_note_] =
      Count(not_finite_, "sample") +
      (not_finite_ == 1 ? " is not a finite number" : " are not finite numbers") + ", taken as 0";
}

bool HaveSndfile() { return kHaveSndfile; }

Result<std::unique_ptr<AudioSource>> OpenAudio(const std::string& path) {
  Result<InputFile> file = OpenInput(path);
  if (!file.ok()) return file.status().In(path);
  std::uint8_t head[12];
  const Result<std::size_t> got = ReadAt(*file, 0, head, sizeof head);
  if (!got.ok()) return got.status().In(path);
  if (*got == 0) return Status(Code::kBadInput, path + ": is empty, expected a sound file");
  if (!IsWav(head, *got)) {
    if (kHaveSndfile) return OpenSndfile(path, *std::move(file));
    return Status(Code::kBadInput, path + ": is " + KindOf(head, *got) +
                                       ", expected WAV: this build has no libsndfile to read more");
  }
  std::vector<std::string> notes;
  const Result<WavHeader> header = ReadWavHeader(*file, &notes);
  if (!header.ok()) return header.status().In(path);
  if (header->samples != WavSamples::kForeign) {
    return OpenWav(path, *std::move(file), *header, std::move(notes));
  }
  if (kHaveSndfile) return OpenSndfile(path, *std::move(file));
  return Status(Code::kBadInput,
                path + ": fmt: samples in format " + std::to_string(header->format) +
                    ", expected PCM (1) or float (3): this build has no libsndfile to read more");
}

}  // namespace gestus::audio
