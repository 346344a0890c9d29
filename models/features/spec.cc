#include "models/features/spec.h"

#include <charconv>
#include <tuple>

#include "models/config.h"
#include "models/io/text.h"
#include "models/normalisation.h"
#include "weights_generated.h"

namespace gestus::features {
namespace {

// Highest numbers of PATS' joints and of OpenPose's face points.
constexpr std::int64_t kLastJoint = 51, kLastLandmark = 69;

using models::ConfigReader;

// The number that was meant: 0.01 rather than the float next to it, which would make f0 drift.
double Decimal(float value) {
  char digits[32];
  const char* end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  double decimal = value;
  std::from_chars(digits, end, decimal);
  return decimal;
}

double Number(ConfigReader& read, const char* field, float stored, double low, double high) {
  const double value = Decimal(stored);
  if (!(value >= low && value <= high))
    read.Fail(field, Significant(value, 6), Significant(low, 6) + " to " + Significant(high, 6));
  return value;
}

std::vector<std::int64_t> Sources(
    ConfigReader& read, const char* field, std::int64_t last,
    const flatbuffers::Vector<flatbuffers::Offset<fb::Joint>>* joints) {
  std::vector<std::int64_t> sources;
  if (joints == nullptr) return sources;
  for (const fb::Joint* joint : *joints)
    sources.push_back(read.Size(field, joint->source(), 0, last));
  return sources;
}

// The network's own configuration, in the ranges that the network checks when it is made: a front
// end may be asked for before that, and what it allocates follows from these numbers.
void ReadZsMstm(ConfigReader& read, const fb::ZsMstm1Config& c, FeatureSpec* spec) {
  spec->layout = Layout::kFrames;
  spec->style_frames = spec->frames = read.Size("frames", c.frames(), 1, 1 << 12);
  if (c.granularity() == fb::Granularity::Segment)
    spec->frames *= read.Size("context_segments", c.context_segments(), 1, 64);
  spec->mel_bins = read.Size("mel_bins", c.ast_content()->mel_bins(), 1, 1 << 10);
  spec->d_text = read.Size("d_text", c.d_text(), 1, 1 << 14);
  spec->frame_rate = Decimal(read.Rate("frame_rate", c.frame_rate()));
  spec->pose_source =
      c.pose_source() == fb::PoseSource::Data ? PoseSource::kData : PoseSource::kNormalize;
}

void ReadLayout(ConfigReader& read, const fb::Network& network, FeatureSpec* spec) {
  switch (network.config_type()) {
    case fb::Config::ZsMstm1Config:
      return ReadZsMstm(read, *network.config_as_ZsMstm1Config(), spec);
    case fb::Config::ZsMstm2Config: {
      const fb::ZsMstm2Config& c = *network.config_as_ZsMstm2Config();
      ReadZsMstm(read, *c.core(), spec);
      spec->d_face = read.Size("d_face", c.d_face(), 1, 1 << 10);
      spec->d_tags = read.Size("d_tags", c.d_tags(), 1, 1 << 10);
      return;
    }
    case fb::Config::AstConfig: {
      const fb::AstConfig& c = *network.config_as_AstConfig();
      spec->layout = Layout::kFrames;
      spec->frames = spec->style_frames = read.Size("frames", c.frames(), 1, 1 << 14);
      spec->mel_bins = read.Size("mel_bins", c.mel_bins(), 1, 1 << 10);
      spec->d_text = 0;
      return;
    }
    case fb::Config::Model1Config: {
      const fb::Model1Config& c = *network.config_as_Model1Config();
      spec->layout = Layout::kWords;
      spec->f0_length = read.Size("f0_length", c.f0_length(), 1, 1 << 12);
      spec->d_text = read.Size("d_text", c.d_text(), 1, 1 << 14);
      spec->text_rows = read.Size("text_rows", c.text_rows(), 1, 1 << 10);
      return;
    }
    case fb::Config::Model2Config: {
      const fb::Model2Config& c = *network.config_as_Model2Config();
      spec->layout = Layout::kWindows;
      spec->f0_length = read.Size("f0_length", c.f0_length(), 1, 1 << 12);
      spec->d_text = read.Size("d_text", c.d_text(), 1, 1 << 14);
      spec->max_words = read.Size("max_words", c.max_words(), 1, 1 << 10);
      return;
    }
    case fb::Config::BertConfig: {
      const fb::BertConfig& c = *network.config_as_BertConfig();
      spec->layout = Layout::kSentences;
      spec->positions = read.Size("positions", c.positions(), 3, 1 << 14);
      spec->classifies = c.head() == fb::BertHead::Classifier;
      return;
    }
    default:
      return;
  }
}

// Each range by itself still leaves room for gigabytes.
void CheckSegment(ConfigReader& read, const FeatureSpec& spec) {
  constexpr std::int64_t kMaxValues = 1 << 25;
  if (spec.layout != Layout::kFrames) return;
  read.Size("values of a segment's text", spec.frames * spec.d_text, 0, kMaxValues);
  read.Size("values of a segment's speech", spec.frames * spec.mel_bins, 0, kMaxValues);
}

void ReadFields(ConfigReader& read, const fb::Features& f, FeatureSpec* spec) {
  spec->speech = read.Enum<SpeechFeature>("speech", f.speech(), fb::SpeechFeature::MAX);
  spec->sample_rate = static_cast<int>(read.Size("sample_rate", f.sample_rate(), 4000, 192000));
  spec->rows = read.Enum<RowPlacement>("rows", f.rows(), fb::RowPlacement::MAX);
  spec->pitch_sample_rate =
      static_cast<int>(read.Size("pitch_sample_rate", f.pitch_sample_rate(), 4000, 192000));
  spec->pitch_hop = Number(read, "pitch_hop", f.pitch_hop(), 0.001, 0.1);
  spec->pitch_minimum = Number(read, "pitch_minimum", f.pitch_minimum(), 20, 1000);
  spec->pitch_maximum = Number(read, "pitch_maximum", f.pitch_maximum(), 40, 2000);
  if (!(spec->pitch_minimum < spec->pitch_maximum))
    read.Fail("pitch_maximum", Significant(spec->pitch_maximum, 6), "more than pitch_minimum");
  spec->pitch_threshold = Number(read, "pitch_threshold", f.pitch_threshold(), 0, 1);
  spec->pitch = read.Enum<PitchReading>("pitch", f.pitch(), fb::PitchReading::MAX);
  spec->pitch_ends = read.Enum<PitchEnds>("pitch_ends", f.pitch_ends(), fb::PitchEnds::MAX);
  spec->pause = Number(read, "pause", f.pause(), 0, 60);
  spec->neck = read.Enum<NeckColumns>("neck", f.neck(), fb::NeckColumns::MAX);
  spec->landmarks = Sources(read, "landmarks", kLastLandmark, f.landmarks());
  if (f.tags() == nullptr) return;
  for (const flatbuffers::String* tag : *f.tags()) spec->tags.push_back(tag->str());
}

}  // namespace

Result<FeatureSpec> ReadFeatureSpec(const fb::Network& network) {
  FeatureSpec spec;
  ConfigReader config("network " + network.name()->str());
  ReadLayout(config, network, &spec);
  CheckSegment(config, spec);
  if (!config.status().ok()) return config.status();
  ConfigReader read("network " + network.name()->str() + ": features");
  if (network.features() != nullptr) ReadFields(read, *network.features(), &spec);
  spec.joints = Sources(read, "joints", kLastJoint, network.joints());
  // The filter bank's own rate; an AST alone takes all of its rows.
  if (spec.speech == SpeechFeature::kFilterBank) {
    constexpr int kFilterBankRate = 16000;
    constexpr double kFilterBankRows = 100;
    spec.sample_rate = kFilterBankRate;
    spec.every_row = network.config_type() == fb::Config::AstConfig;
    if (spec.every_row) spec.frame_rate = kFilterBankRows;
  }
  if (!spec.tags.empty() && static_cast<std::int64_t>(spec.tags.size()) != spec.d_tags)
    read.Fail("tags", std::to_string(spec.tags.size()), "d_tags, " + std::to_string(spec.d_tags));
  if (!spec.landmarks.empty() &&
      2 * static_cast<std::int64_t>(spec.landmarks.size()) != spec.d_face)
    read.Fail("landmarks", std::to_string(spec.landmarks.size()),
              "half of d_face, " + std::to_string(spec.d_face));
  if (!read.status().ok()) return read.status();
  if (spec.layout == Layout::kArrays || spec.layout == Layout::kSentences) return spec;
  for (const auto& [stream, columns, mean] :
       {std::tuple{"speech", spec.mel_bins, &spec.absent_speech},
        std::tuple{"text", spec.d_text, &spec.absent_text}}) {
    if (columns == 0) continue;
    Result<models::Normalisation> statistics = models::ReadNormalisation(network, stream, columns);
    if (!statistics.ok()) return statistics.status();
    *mean = std::move(statistics->mean);
  }
  return spec;
}

}  // namespace gestus::features
