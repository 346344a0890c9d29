// Writes what fuzzing starts from, a folder for each target: the goldens, the samples of the tests,
// and small files made here.
//
//   fuzz_seeds GOLDENS FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "models/cli/npy.h"
#include "tests/audio/wav_builder.h"
#include "tests/words/samples.h"

namespace gestus::fuzz {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) { fs::create_directories(path_); }
  void Add(std::string_view bytes) {
    std::ofstream(path_ / std::to_string(count_++), std::ios::binary) << bytes;
  }
  void AddCopies(const fs::path& from, const std::string& extension) {
    for (const auto& entry : fs::directory_iterator(from)) {
      if (entry.path().extension() != extension) continue;
      fs::copy_file(entry.path(), path_ / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
    }
  }

 private:
  fs::path path_;
  int count_ = 0;
};

void AddArrays(Folder* folder) {
  const std::string element(6 * 4, '\1');
  folder->Add(cli::NpyHeaderText(DType::kF32, {2, 3}) + element);
  folder->Add(cli::NpyHeaderText(DType::kI32, {6}) + element);
  std::string text = "{'descr': '>f8', 'fortran_order': True, 'shape': (1, 3), }";
  text.append(128 - 12 - text.size() - 1, ' ');
  text += '\n';
  folder->Add(std::string("\x93NUMPY\2\0", 8) + static_cast<char>(text.size()) +
              std::string(3, '\0') + text + element);
}

void AddSounds(Folder* folder) {
  const audio::ByteVector data(48, 0x3F);
  const auto add = [&](const audio::WavSpec& spec) {
    const audio::ByteVector file = audio::Wav(spec, data);
    folder->Add({reinterpret_cast<const char*>(file.data()), file.size()});
  };
  for (const int bits : {8, 16, 24, 32}) add({.bits = static_cast<std::uint16_t>(bits)});
  add({.format = 3, .bits = 32});
  add({.format = 3, .channels = 2, .bits = 64, .rate = 44100});
  add({.channels = 3, .bits = 12, .extensible = true});
  add({.format = 2, .bits = 4});
  add({.data_size = 0xFFFFFFFF});
  audio::ByteVector list;
  audio::PutChunk(&list, "LIST", {1, 2, 3});
  add({.before_fmt = list, .before_data = list, .after_data = list});
  audio::ByteVector ds64, sizes;  // RF64: sizes of 8 bytes, and an empty table
  for (const std::uint64_t size : {200, 48, 24}) audio::Put(&sizes, size, 8);
  audio::Put(&sizes, 0, 4);
  audio::PutChunk(&ds64, "ds64", sizes);
  add({.form = "RF64", .data_size = 0xFFFFFFFF, .before_fmt = ds64});
}

std::string Points(int count, int at) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text +=
        (i == 0 ? "" : ",") + std::to_string(at + i) + "," + std::to_string(2 * at + i) + ",0.5";
  }
  return "[" + text + "]";
}

void AddPoses(Folder* folder) {
  const std::string one = "{\"pose_keypoints_2d\":" + Points(25, 100) + "}";
  const std::string other =
      "{\"pose_keypoints\":" + Points(18, 50) + ",\"face_keypoints\":" + Points(70, 60) +
      ",\"hand_left_keypoints\":" + Points(21, 70) + ",\"hand_right_keypoints\":[]}";
  const auto frame = [](const std::string& people) {
    return "{\"version\":1.3,\"people\":[" + people + "]}";
  };
  folder->Add(frame(one));
  folder->Add(frame(other));
  folder->Add(frame(one + "," + other));
  folder->Add(frame(""));
  folder->Add(frame(one) + '\0' + frame(other + "," + one) + '\0' + frame("") + '\0' + frame(one));
}

void AddFaces(Folder* folder) {
  folder->Add("AU01_r,AU45_r\n0.5,1\n0,5\n");
  std::string text = "frame, face_id, timestamp, confidence, success, pose_Rx, AU01_r\n";
  for (int t = 1; t < 9; t += 1 + t % 3) {
    for (int face = 0; face < 2; ++face) {
      text += std::to_string(t) + ", " + std::to_string(face) + ", 0." +
              std::to_string(t * 4 + 10) + ", 0.9" + std::to_string(face) + ", " +
              std::to_string(t % 2) + ", -0.1, 1e-1\n";
    }
  }
  folder->Add(text);
  folder->Add("\xEF\xBB\xBF\"timestamp\",\"AU01_r\"\r\n0,nan\r\n0.04,-nan(ind)\r\n0.08,1\r\n");
}

void AddTexts(Folder* folder) {
  folder->Add("The cafe\u0301's \u0130ngs, ABAS. \u4E2D\u6587 \u039F\u03A3 \uAC01 \xFF [CLS]");
  folder->Add(std::string("[UNK]\n[CLS]\n[SEP]\na\n##b\n") + '\0' + "abab ab. b");
  folder->Add(std::string(300, 'a') + " e\u0327\u0301 \u0344 \u00AD\u200D");
}

void WriteAll(const fs::path& goldens, const fs::path& to) {
  for (const char* name : {"weights", "front_end"}) Folder(to / name).AddCopies(goldens, ".fb");
  Folder npz(to / "npz");
  npz.AddCopies(goldens, ".npz");
  AddArrays(&npz);
  Folder wav(to / "wav"), openpose(to / "openpose"), openface(to / "openface");
  AddSounds(&wav);
  AddPoses(&openpose);
  AddFaces(&openface);
  Folder transcript(to / "transcript");
  for (const words::Sample& sample : words::Samples()) transcript.Add(sample.bytes);
  Folder wordpiece(to / "wordpiece");
  AddTexts(&wordpiece);
}

}  // namespace
}  // namespace gestus::fuzz

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: fuzz_seeds GOLDENS FOLDER\n"), 2;
  gestus::fuzz::WriteAll(argv[1], argv[2]);
  return 0;
}
