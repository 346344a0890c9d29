#include "models/cli/inputs.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>

#include "models/io/file.h"
#include "models/words/transcript.h"

namespace gestus::cli {
namespace {

constexpr std::size_t kHead = 4096;
// More files than any speaker's folder that is not itself a folder of frames.
constexpr std::size_t kMaxNames = 1000000;
constexpr std::string_view kKeypoints = "_keypoints.json";

bool IsFolder(const std::string& path) {
  struct stat info = {};
  return ::stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode);
}

/// Names in a folder, without hidden ones, in order.
Result<std::vector<std::string>> NamesIn(const std::string& path) {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(path.c_str()), ::closedir);
  if (folder == nullptr)
    return Status(Code::kIo, path + ": cannot be opened (" + std::strerror(errno) +
                                 "), expected a readable folder");
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(folder.get())) {
    if (entry->d_name[0] == '.') continue;
    if (names.size() == kMaxNames)
      return Status(Code::kBadInput, path + ": more than " + std::to_string(kMaxNames) +
                                         " files, expected the folder of one recording");
    names.emplace_back(entry->d_name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool HasFrames(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(),
                     [](const std::string& name) { return name.ends_with(kKeypoints); });
}

Result<std::string> Head(const std::string& path) {
  Result<InputFile> file = OpenInput(path);
  if (!file.ok()) return file.status().In(path);
  std::string head(kHead, '\0');
  const ssize_t n = ::read(file->fd.get(), head.data(), head.size());
  if (n < 0) return Status(Code::kIo, path + ": cannot be read (" + std::strerror(errno) + ")");
  head.resize(static_cast<std::size_t>(n));
  return head;
}

bool IsAudio(std::string_view head) {
  for (const std::string_view magic :
       {"RIFF", "RF64", "RIFX", "fLaC", "OggS", "ID3", "FORM", ".snd", "caff"}) {
    if (head.starts_with(magic)) return true;
  }
  // The first bytes of an MP3 frame without a tag.
  return head.size() > 1 && static_cast<unsigned char>(head[0]) == 0xff &&
         (static_cast<unsigned char>(head[1]) & 0xe0U) == 0xe0U && head[1] != '\xfe' &&
         head[1] != '\xff';
}

bool HasAudioEnding(const std::string& path) {
  for (const char* ending : {".wav", ".WAV", ".flac", ".mp3", ".ogg", ".opus", ".aiff"}) {
    if (path.ends_with(ending)) return true;
  }
  return false;
}

InputKind KindOfText(std::string_view head) {
  const auto has = [head](std::string_view text) {
    return head.find(text) != std::string_view::npos;
  };
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  const bool json = first != std::string_view::npos && head[first] == '{';
  if (json && (has("\"people\"") || has("pose_keypoints"))) return InputKind::kOpenPose;
  const std::string_view line = head.substr(0, head.find('\n'));
  if (line.find(',') != std::string_view::npos && (line.find("pose_Rx") != std::string_view::npos ||
                                                   line.find("AU01_r") != std::string_view::npos))
    return InputKind::kOpenFace;
  return InputKind::kTranscript;
}

std::string* PlaceOf(InputKind kind, Inputs* inputs) {
  switch (kind) {
    case InputKind::kWeights:
      return &inputs->weights;
    case InputKind::kArrays:
      return &inputs->arrays;
    case InputKind::kAudio:
      return &inputs->audio;
    case InputKind::kTranscript:
      return &inputs->transcript;
    case InputKind::kOpenPose:
      return &inputs->openpose;
    case InputKind::kOpenFace:
      return &inputs->openface;
    default:
      return nullptr;
  }
}

const char* NameOf(InputKind kind) {
  switch (kind) {
    case InputKind::kWeights:
      return "weights file";
    case InputKind::kArrays:
      return "file of arrays";
    case InputKind::kAudio:
      return "recording";
    case InputKind::kTranscript:
      return "transcript";
    case InputKind::kOpenPose:
      return "set of OpenPose frames";
    default:
      return "OpenFace file";
  }
}

Status Put(const std::string& path, InputKind kind, Inputs* inputs) {
  std::string* place = PlaceOf(kind, inputs);
  if (place == nullptr)
    return Status(Code::kBadInput, path +
                                       ": neither a recording, a transcript, key points nor "
                                       "arrays, expected one of these");
  if (!place->empty())
    return Status(Code::kBadInput,
                  path + ": a second " + NameOf(kind) + " beside " + *place + ", expected one");
  *place = path;
  return Status();
}

}  // namespace

Result<InputKind> Recognise(const std::string& path) {
  if (IsFolder(path)) {
    const Result<std::vector<std::string>> names = NamesIn(path);
    if (!names.ok()) return names.status();
    return HasFrames(*names) ? InputKind::kOpenPose : InputKind::kFolder;
  }
  const Result<std::string> head = Head(path);
  if (!head.ok()) return head.status();
  // These names promise arrays, so that their reader complains of what is none; and an empty file
  // is what its name says.
  if (path.ends_with(".npz") || path.ends_with(".npy")) return InputKind::kArrays;
  if (head->empty() && HasAudioEnding(path)) return InputKind::kAudio;
  if (head->starts_with("GESTUSW")) return InputKind::kWeights;
  if (head->starts_with("PK") || head->starts_with("\x93NUMPY")) return InputKind::kArrays;
  if (IsAudio(*head)) return InputKind::kAudio;
  const bool utf16 = head->starts_with("\xff\xfe") || head->starts_with("\xfe\xff");
  if (!utf16 && head->find('\0') != std::string::npos) return InputKind::kUnknown;
  return KindOfText(*head);
}

namespace {

/// The kind of a file that a folder holds, where text is one only if it has times.
Result<InputKind> RecogniseInFolder(const std::string& path) {
  const Result<InputKind> kind = Recognise(path);
  if (!kind.ok()) return kind.status();
  if (*kind == InputKind::kFolder) return InputKind::kUnknown;
  if (*kind != InputKind::kTranscript) return kind;
  const Result<std::string> head = Head(path);
  if (!head.ok()) return head.status();
  return words::LooksTimed(*head) ? InputKind::kTranscript : InputKind::kUnknown;
}

Status PutFolder(const std::string& path, Inputs* inputs) {
  const Result<std::vector<std::string>> names = NamesIn(path);
  if (!names.ok()) return names.status();
  const bool frames = HasFrames(*names);
  if (frames) GESTUS_RETURN_IF_ERROR(Put(path, InputKind::kOpenPose, inputs));
  for (const std::string& name : *names) {
    if (frames && name.ends_with(kKeypoints)) continue;
    const std::string file = path + (path.ends_with('/') ? "" : "/") + name;
    const Result<InputKind> kind = RecogniseInFolder(file);
    if (!kind.ok()) return kind.status();
    if (*kind == InputKind::kUnknown) {
      inputs->notes.push_back(file + " was not used");
      continue;
    }
    GESTUS_RETURN_IF_ERROR(Put(file, *kind, inputs));
  }
  return Status();
}

}  // namespace

Result<Inputs> SortInputs(const std::vector<std::string>& paths, const std::string& transcript) {
  Inputs inputs;
  inputs.transcript = transcript;
  for (const std::string& path : paths) {
    if (path == transcript) continue;
    if (IsFolder(path)) {
      GESTUS_RETURN_IF_ERROR(PutFolder(path, &inputs));
      continue;
    }
    const Result<InputKind> kind = Recognise(path);
    if (!kind.ok()) return kind.status();
    GESTUS_RETURN_IF_ERROR(Put(path, *kind, &inputs));
  }
  if (inputs.OnlyArrays() && inputs.arrays.empty() && inputs.weights.empty())
    return Status(Code::kBadInput, paths.front() +
                                       ": nothing in it can be used, expected a recording, a "
                                       "transcript, key points or arrays");
  return inputs;
}

}  // namespace gestus::cli
