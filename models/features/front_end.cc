#include "models/features/front_end.h"

#include <algorithm>
#include <cmath>

#include "models/features/frame_inputs.h"
#include "models/features/samples.h"
#include "models/features/sentence_inputs.h"
#include "models/features/word_inputs.h"
#include "models/io/text.h"
#include "weights_generated.h"

namespace gestus::features {

using models::Array;
using models::Arrays;

namespace {

template <class T>
Result<std::unique_ptr<InputStream>> Own(Result<std::unique_ptr<T>> stream) {
  if (!stream.ok()) return stream.status();
  return std::unique_ptr<InputStream>(*std::move(stream));
}

}  // namespace

Result<std::unique_ptr<FrontEnd>> FrontEnd::Make(std::shared_ptr<const WeightsFile> file,
                                                 const std::string& name,
                                                 const models::NetworkOptions& options) {
  const fb::Network* record = file->FindNetwork(name);
  if (record == nullptr)
    return Status(Code::kNotFound, file->path() + ": no network called " + name);
  Result<FeatureSpec> spec = ReadFeatureSpec(*record);
  if (!spec.ok()) return spec.status().In(file->path());
  std::unique_ptr<FrontEnd> front_end(new FrontEnd);
  front_end->text_networks_ = FindTextNetworks(*file);
  front_end->spec_ = *std::move(spec);
  front_end->record_ = record;
  front_end->file_ = std::move(file);
  front_end->options_ = options;
  return front_end;
}

Result<words::Transcript> ReadWords(const Recording& recording, Account* account) {
  Result<words::Transcript> transcript =
      words::ReadTranscript(recording.transcript, {.plain_text = true});
  if (!transcript.ok()) return transcript;
  if (transcript->plain_text && !recording.audio.empty()) {
    const Result<double> seconds = SecondsOf(recording.audio);
    if (!seconds.ok()) return seconds.status();
    if (*seconds > 0) words::SpreadOver(*seconds, &*transcript);
  }
  account->notes.insert(account->notes.end(), transcript->notes.begin(), transcript->notes.end());
  return transcript;
}

std::vector<std::string> FrontEnd::Makes(const FeatureSpec& spec, const Recording& recording) {
  const bool audio = !recording.audio.empty(), words = !recording.transcript.empty();
  if (!audio && !words) return {};
  switch (spec.layout) {
    case Layout::kFrames:
      // AST hears; ZS-MSTM takes both, and makes do with one.
      if (spec.d_text == 0)
        return audio ? std::vector<std::string>{"speech"} : std::vector<std::string>{};
      return {"speech", "text"};
    case Layout::kWords:
    case Layout::kWindows:
      return {"f0", "text"};
    default:
      // Beside gesture networks, BERT serves them.
      return {};
  }
}

Result<const words::Transcript*> FrontEnd::OpenTranscript(const Recording& recording,
                                                          Account* account) {
  if (recording.transcript.empty()) return nullptr;
  Result<words::Transcript> transcript = ReadWords(recording, account);
  if (!transcript.ok()) return transcript.status();
  transcripts_.push_back(std::make_unique<words::Transcript>(*std::move(transcript)));
  return transcripts_.back().get();
}

// Made when first wanted: the weights of BERT are many.
Result<WordEncoder*> FrontEnd::Encoder(Account* account) {
  if (encoder_) return &*encoder_;
  account->notes.insert(account->notes.end(), text_networks_.notes.begin(),
                        text_networks_.notes.end());
  text_networks_.notes.clear();
  if (text_networks_.encoder.empty()) return nullptr;
  Result<TokenNetwork> network = TokenNetwork::Make(file_, text_networks_.encoder, options_);
  if (!network.ok()) return network.status();
  if (network->width() != spec_.d_text) {
    account->notes.push_back("network " + text_networks_.encoder + " gives " +
                             std::to_string(network->width()) + " features of a word, not " +
                             std::to_string(spec_.d_text) + ", and was not used");
    return nullptr;
  }
  encoder_.emplace(*std::move(network));
  return &*encoder_;
}

Result<ActClassifier*> FrontEnd::Classifier() {
  if (classifier_) return &*classifier_;
  if (text_networks_.classifier.empty()) return nullptr;
  Result<TokenNetwork> network = TokenNetwork::Make(file_, text_networks_.classifier, options_);
  if (!network.ok()) return network.status();
  classifier_.emplace(*std::move(network));
  return &*classifier_;
}

Result<WordEncoder*> FrontEnd::EncoderFor(const words::Transcript* transcript, bool has_text,
                                          Account* account) {
  if (spec_.d_text == 0 || has_text || transcript == nullptr || transcript->words.empty())
    return nullptr;
  return Encoder(account);
}

Result<std::unique_ptr<InputStream>> FrontEnd::OpenSentences(const Recording& recording,
                                                             const words::Transcript* transcript,
                                                             Account* account) {
  if (transcript == nullptr)
    return Status(Code::kBadInput, recording.audio + ": no words, expected a transcript for BERT");
  const Result<models::WordPiece> tokeniser = ReadTokeniser(*file_, *record_);
  if (!tokeniser.ok()) return tokeniser.status();
  if (!recording.audio.empty())
    account->notes.push_back(recording.audio + " was not used: the network takes words");
  for (const auto& [name, array] : recording.arrays)
    account->notes.push_back(name + " in " + recording.arrays_path +
                             " was not used: it is made of the words");
  return Own(SentenceInputs::Open(spec_, *transcript, recording.transcript, *tokeniser, account));
}

Result<std::unique_ptr<InputStream>> FrontEnd::Open(const Recording& recording, Account* account) {
  const Result<const words::Transcript*> transcript = OpenTranscript(recording, account);
  if (!transcript.ok()) return transcript.status();
  if (!recording.openpose.empty())
    account->notes.push_back(recording.openpose + " was not used: poses belong to a style");
  if (spec_.layout == Layout::kArrays)
    return Status(Code::kInvalidArgument,
                  file_->path() + ": network " + record_->name()->str() +
                      ": takes arrays only, expected an .npz (infer-cli info names them)");
  if (spec_.layout == Layout::kSentences) return OpenSentences(recording, *transcript, account);
  const Result<WordEncoder*> encoder =
      EncoderFor(*transcript, recording.arrays.count("text") != 0, account);
  if (!encoder.ok()) return encoder.status();
  if (spec_.layout == Layout::kFrames)
    return Own(FrameInputs::Open(spec_,
                                 {.arrays = recording.arrays,
                                  .arrays_path = recording.arrays_path,
                                  .audio = recording.audio,
                                  .transcript = *transcript,
                                  .transcript_path = recording.transcript,
                                  .encoder = *encoder},
                                 account));
  return Own(WordInputs::Open(spec_,
                              {.arrays = recording.arrays,
                               .arrays_path = recording.arrays_path,
                               .audio = recording.audio,
                               .transcript = *transcript,
                               .transcript_path = recording.transcript,
                               .encoder = *encoder},
                              account));
}

}  // namespace gestus::features
