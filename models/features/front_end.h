// From a recording to the inputs of one network of a weights file.
//
//   auto front_end = FrontEnd::Make(file, "zs_mstm1", {});
//   Account account;
//   auto stream =
//       (*front_end)->Open({.audio = "speech.wav", .transcript = "words.json"}, &account);
//   while (true) {
//     auto inputs = (*stream)->Next(64);            // arrays as infer-cli takes them
//     if (!inputs.ok() || inputs->empty()) break;
//     network->Run(*inputs, ...);
//   }                                               // (*stream)->Notes() is complete now
//   auto clip = (*front_end)->StyleClip({.audio = ..., .transcript = ..., .openpose = "poses/"},
//                                       &account); // style_speech, style_text, style_pose, ...
#ifndef GESTUS_MODELS_FEATURES_FRONT_END_H_
#define GESTUS_MODELS_FEATURES_FRONT_END_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/weights_file.h"
#include "models/features/input_stream.h"
#include "models/features/spec.h"
#include "models/features/word_encoder.h"
#include "models/network.h"
#include "models/words/transcript.h"

namespace gestus::features {

/// What there is of one recording; every part may be absent.
struct Recording {
  std::string audio{};       ///< path of a recording
  std::string transcript{};  ///< path of words with times, or of plain text, which is spread evenly
  std::string openpose{};    ///< path of a folder of OpenPose's files, or of one
  double pose_rate = 0;  ///< frames per second of openpose; 0: as the audio's length says, else 15
  models::Arrays arrays{};  ///< inputs of the network that are there already
  std::string arrays_path{};

  bool Any() const { return !audio.empty() || !transcript.empty() || !openpose.empty(); }
};

/// The words of `recording`, which has some; those of plain text are spread over its audio.  Notes
/// go to the account; errors begin with the path.
Result<words::Transcript> ReadWords(const Recording& recording, Account* account);

class FrontEnd {
 public:
  /// For network `name` (empty: the only one) of `file`; the words' features come from the file's
  /// BERT and the dialog acts from its classifier, where it has them.
  static Result<std::unique_ptr<FrontEnd>> Make(std::shared_ptr<const WeightsFile> file,
                                                const std::string& name,
                                                const models::NetworkOptions& options);

  const FeatureSpec& spec() const { return spec_; }

  /// Names of the inputs that Open() can make of `recording`.
  static std::vector<std::string> Makes(const FeatureSpec& spec, const Recording& recording);

  /// The stream must not outlive the front end.  Errors name the file; one is that the network
  /// takes nothing that could be made.
  Result<std::unique_ptr<InputStream>> Open(const Recording& recording, Account* account);

  /// All arrays of a style clip at once, "style_speech" and so on.
  Result<models::Arrays> StyleClip(const Recording& recording, Account* account);

 private:
  FrontEnd() = default;
  Result<const words::Transcript*> OpenTranscript(const Recording& recording, Account* account);
  Result<WordEncoder*> Encoder(Account* account);
  Result<ActClassifier*> Classifier();
  Result<std::unique_ptr<InputStream>> OpenSentences(const Recording& recording,
                                                     const words::Transcript* transcript,
                                                     Account* account);
  /// The encoder, where `transcript` is needed and there is one.
  Result<WordEncoder*> EncoderFor(const words::Transcript* transcript, bool has_text,
                                  Account* account);
  Status AddMotion(const Recording& recording, Account* account, models::Arrays* clip);
  Status AddSpeechAndText(const Recording& recording, const words::Transcript* transcript,
                          Account* account, models::Arrays* clip);
  Result<std::vector<std::int64_t>> TagColumns(const std::vector<std::string>& labels) const;
  Status AddTags(const words::Transcript* transcript, Account* account, models::Arrays* clip);

  std::shared_ptr<const WeightsFile> file_;
  models::NetworkOptions options_;
  const fb::Network* record_ = nullptr;  // lives in file_
  FeatureSpec spec_;
  TextNetworks text_networks_;
  std::optional<WordEncoder> encoder_;
  std::optional<ActClassifier> classifier_;
  std::vector<std::unique_ptr<words::Transcript>> transcripts_;
};

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_FRONT_END_H_
