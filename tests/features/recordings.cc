#include "tests/features/recordings.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "models/audio/resampler.h"
#include "models/audio/rows.h"
#include "tests/audio/wav_builder.h"
#include "tests/engine/weights_builder.h"
#include "weights_generated.h"

namespace gestus::features {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

// The payload of a tensor is bytes, whatever its type.
std::vector<float> Payload(const void* data, std::size_t bytes) {
  std::vector<float> values((bytes + sizeof(float) - 1) / sizeof(float));
  std::memcpy(values.data(), data, bytes);
  return values;
}

void CopyTensors(const WeightsFile& from, const std::string& prefix, test::FileSpec* to) {
  for (const WeightsFile::Entry& entry : from.tensors()) {
    if (entry.name.starts_with("self_test")) continue;
    test::TensorSpec tensor;
    tensor.name = prefix + entry.name;
    for (int i = 0; i < entry.view.shape.rank(); ++i)
      tensor.shape.push_back(static_cast<std::uint32_t>(entry.view.shape[i]));
    tensor.values = Payload(entry.view.data, entry.bytes);
    tensor.dtype = entry.view.dtype == DType::kU8 ? fb::DType::U8 : fb::DType::F32;
    to->tensors.push_back(std::move(tensor));
  }
}

std::shared_ptr<const WeightsFile> Golden(const std::string& name) {
  auto file = WeightsFile::Open(std::string(GESTUS_GOLDENS) + "/" + name + ".fb");
  EXPECT_TRUE(file.ok()) << file.status().message();
  return *file;
}

void AddBert(test::FileSpec* file) {
  CopyTensors(*Golden("bert_vocabulary"), "bert.", file);
  test::NetworkSpec& network = file->networks.emplace_back();
  network.name = "bert";
  network.prefix = "bert.";
  network.type = fb::Config::BertConfig;
  network.config = [](FlatBufferBuilder& b) {
    return fb::CreateBertConfig(b, 2, 16, 4, 24, 20, 12, 2, 1e-5f, false).Union();
  };
}

void AddClassifier(test::FileSpec* file) {
  CopyTensors(*Golden("bert_classifier"), "acts.", file);
  std::string vocabulary = "[PAD]\n[UNK]\n[CLS]\n[SEP]";
  for (int i = 0; i < 16; ++i) vocabulary += "\nword" + std::to_string(i);
  file->tensors.push_back({"acts.vocabulary",
                           {static_cast<std::uint32_t>(vocabulary.size())},
                           Payload(vocabulary.data(), vocabulary.size()),
                           fb::DType::U8});
  test::NetworkSpec& network = file->networks.emplace_back();
  network.name = "acts";
  network.prefix = "acts.";
  network.type = fb::Config::BertConfig;
  network.config = [](FlatBufferBuilder& b) {
    const auto labels =
        b.CreateVectorOfStrings(std::vector<std::string>{"question", "statement", "thanks"});
    return fb::CreateBertConfig(b, 2, 16, 4, 24, 110, 12, 0, 1e-12f, true, fb::BertHead::Classifier,
                                labels)
        .Union();
  };
}

}  // namespace

std::vector<float> Voice(double seconds, int rate) {
  std::vector<float> samples(static_cast<std::size_t>(std::llround(seconds * rate)));
  std::uint32_t noise = 1;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / rate;
    noise = noise * 1664525u + 1013904223u;
    const double loud = std::max(0.0, std::sin(2 * std::numbers::pi * 0.7 * t));
    double sum = 0.02 * (static_cast<double>(noise >> 8) / (1 << 24) - 0.5);
    for (int k = 1; k <= 12; ++k)
      sum += 0.2 * loud / k * std::sin(2 * std::numbers::pi * 120 * k * t);
    samples[i] = static_cast<float>(sum);
  }
  return samples;
}

std::string WriteWav(const TempFolder& folder, const std::string& name,
                     const std::vector<float>& samples, int rate, int channels) {
  audio::ByteVector data;
  for (const float sample : samples) {
    const auto value = static_cast<std::int16_t>(std::lround(32767 * sample));
    for (int channel = 0; channel < channels; ++channel)
      audio::Put(&data, static_cast<std::uint16_t>(value), 2);
  }
  audio::WavSpec spec;
  spec.channels = static_cast<std::uint16_t>(channels);
  spec.rate = static_cast<std::uint32_t>(rate);
  const audio::ByteVector file = audio::Wav(spec, data);
  return folder.Write(name, {reinterpret_cast<const char*>(file.data()), file.size()});
}

std::vector<float> Resampled(const std::string& path, int rate) {
  auto source = audio::OpenAudio(path);
  EXPECT_TRUE(source.ok()) << source.status().message();
  auto resampler = audio::Resampler::Make((*source)->sample_rate(), rate);
  EXPECT_TRUE(resampler.ok());
  std::vector<float> samples(static_cast<std::size_t>((*source)->frames()));
  EXPECT_EQ(*(*source)->Read(samples.data(), samples.size()), samples.size());
  return audio::AllRows(&*resampler, samples.data(), samples.size());
}

std::string WriteWords(const TempFolder& folder, const std::string& name,
                       const std::vector<words::Word>& words) {
  std::string text;
  for (const words::Word& word : words)
    text += std::to_string(word.start) + " " + std::to_string(word.end) + " " + word.text + "\n";
  return folder.Write(name, text);
}

std::shared_ptr<const WeightsFile> GoldenBert() { return Golden("bert_vocabulary"); }

WordEncoder GoldenEncoder() {
  auto network = TokenNetwork::Make(GoldenBert(), "bert", {});
  EXPECT_TRUE(network.ok()) << network.status().message();
  return WordEncoder(*std::move(network));
}

std::vector<float> MeansOf(const std::vector<std::string>& words) {
  WordEncoder encoder = GoldenEncoder();
  const Result<Pieces> pieces = encoder.Encode(words);
  EXPECT_TRUE(pieces.ok());
  return pieces->WordMeans();
}

std::shared_ptr<const WeightsFile> TalkFile(const FileOptions& options) {
  test::FileSpec file;
  test::NetworkSpec& network = file.networks[0];
  network.name = "talk";
  network.type = fb::Config::ZsMstm2Config;
  network.config = [](FlatBufferBuilder& b) {
    const auto ast = fb::CreateAstConfig(b, 8, 10);
    return fb::CreateZsMstm2Config(b, fb::CreateZsMstm1Config(b, 8, 16, 6, 8, ast), 4, 3).Union();
  };
  network.joints = {{"Neck", -1, false, 0}, {"RShoulder", 0, false, 1}, {"LShoulder", 0, false, 4}};
  network.statistics = {{"text", {0.5f}, {1.0f}}};
  network.features = [&](FlatBufferBuilder& b) {
    const std::vector<Offset<fb::Joint>> points = {
        fb::CreateJoint(b, b.CreateString("nose"), -1, 30),
        fb::CreateJoint(b, b.CreateString("chin"), -1, 8)};
    const auto landmarks = b.CreateVector(points);
    const auto tags = b.CreateVectorOfStrings(options.tags);
    fb::FeaturesBuilder f(b);
    f.add_sample_rate(8000);
    f.add_landmarks(landmarks);
    f.add_tags(tags);
    if (options.neck_is_zero) f.add_neck(fb::NeckColumns::Zero);
    return f.Finish();
  };
  file.tensors = {{"x", {1}, {0}}};
  if (options.texts) {
    AddBert(&file);
    AddClassifier(&file);
  }
  const test::Bytes bytes = file.Build();
  auto made = WeightsFile::FromMemory(bytes.data(), bytes.size(), "talk.fb");
  EXPECT_TRUE(made.ok()) << made.status().message();
  return *made;
}

std::unique_ptr<FrontEnd> TalkFrontEnd(const FileOptions& options) {
  auto front_end = FrontEnd::Make(TalkFile(options), "talk", {});
  EXPECT_TRUE(front_end.ok()) << front_end.status().message();
  return *std::move(front_end);
}

FeatureSpec FramesSpec() {
  FeatureSpec spec;
  spec.layout = Layout::kFrames;
  spec.frames = spec.style_frames = 8;
  spec.mel_bins = 10;
  spec.d_text = 16;
  spec.sample_rate = 8000;
  return spec;
}

models::Arrays ReadAll(InputStream* stream, const std::vector<std::int64_t>& sizes) {
  models::Arrays all;
  for (std::size_t i = 0;; ++i) {
    Result<models::Arrays> next = stream->Next(sizes[i % sizes.size()]);
    EXPECT_TRUE(next.ok()) << next.status().message();
    if (!next.ok() || next->empty()) return all;
    for (auto& [name, array] : *next) {
      models::Array& whole = all[name];
      array.shape[0] += whole.shape.empty() ? 0 : whole.shape[0];
      whole.dtype = array.dtype;
      whole.shape = array.shape;
      whole.f32.insert(whole.f32.end(), array.f32.begin(), array.f32.end());
      whole.i32.insert(whole.i32.end(), array.i32.begin(), array.i32.end());
    }
  }
}

bool Says(const std::vector<std::string>& lines, const std::string& words) {
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

}  // namespace gestus::features
