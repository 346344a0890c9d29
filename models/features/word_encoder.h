// Words to X_text: the tokeniser and BERT of a weights file, on words that have times.
//
//   auto encoder = WordEncoder::Make(file, "bert");
//   auto pieces = (*encoder)->Encode({"deep", "learning"});
//   // pieces->rows (n, 768): the hidden states of the pieces; pieces->counts: {1, 1}
//
// As PATS does it (Ahuja et al. 2020; features.md 5.4): words are joined by blanks, cut into chunks
// of at most positions - 2 pieces, each between [CLS] and [SEP], and the last hidden layer is kept.
#ifndef GESTUS_MODELS_FEATURES_WORD_ENCODER_H_
#define GESTUS_MODELS_FEATURES_WORD_ENCODER_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/status.h"
#include "engine/weights_file.h"
#include "models/network.h"
#include "models/text/wordpiece.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::features {

/// Vectors of pieces, word after word.
struct Pieces {
  std::vector<std::int64_t> counts;  ///< of each word; 0 for one without letters or signs
  std::int64_t width = 0;
  std::vector<float> rows;  ///< (sum of counts, width)

  /// The mean of each word's pieces: (words, width), zeros for a word without any.
  std::vector<float> WordMeans() const;
};

/// The tokeniser of `network`, a BertConfig, from the vocabulary that travels with it.
Result<models::WordPiece> ReadTokeniser(const WeightsFile& file, const fb::Network& network);

/// A tokeniser and the network behind it.  The network may be used by one thread at a time.
class TokenNetwork {
 public:
  /// `name` is a BertConfig network of the file whose vocabulary travels with it.
  static Result<TokenNetwork> Make(std::shared_ptr<const WeightsFile> file, const std::string& name,
                                   const models::NetworkOptions& options);

  const models::WordPiece& words() const { return *words_; }
  std::int64_t max_tokens() const { return max_tokens_; }  ///< of one sequence, without its frames
  const std::vector<std::string>& labels() const { return labels_; }
  std::int64_t width() const { return width_; }  ///< of hidden states

  Result<models::Arrays> Run(const std::vector<std::int32_t>& ids,
                             const models::RunOptions& options);

 private:
  TokenNetwork() = default;

  std::shared_ptr<const models::WordPiece> words_;
  std::unique_ptr<models::Network> network_;
  std::int64_t max_tokens_ = 0, width_ = 0;
  std::vector<std::string> labels_;
};

class WordEncoder {
 public:
  explicit WordEncoder(TokenNetwork network) : network_(std::move(network)) {}
  std::int64_t width() const { return network_.width(); }

  /// Vectors of `words`, which see one another within chunks of positions - 2 pieces.
  Result<Pieces> Encode(const std::vector<std::string>& words,
                        const models::RunOptions& options = {});

 private:
  friend class PieceRows;
  TokenNetwork network_;
};

/// The vectors of the pieces of a transcript of any length, computed as they are asked for, best in
/// order: one chunk of positions - 2 pieces is kept.
class PieceRows {
 public:
  /// `encoder` outlives the rows.
  PieceRows(WordEncoder* encoder, const std::vector<std::string>& words);

  /// Pieces of each word.
  const std::vector<std::int64_t>& counts() const { return counts_; }
  /// The vector of piece number `piece`, counted over all words; valid until the next call.
  Result<const float*> Row(std::int64_t piece, const models::RunOptions& options = {});

 private:
  WordEncoder* encoder_;
  std::vector<std::int64_t> counts_;
  std::vector<std::int32_t> ids_;
  std::int64_t chunk_ = -1;  // the one that rows_ holds
  std::vector<float> rows_;
};

/// Sentences to dialog acts (thesis 4.2.3, 7.3.2).
class ActClassifier {
 public:
  explicit ActClassifier(TokenNetwork network) : network_(std::move(network)) {}
  const std::vector<std::string>& labels() const { return network_.labels(); }

  struct Act {
    std::int32_t label = -1;  ///< -1: a sentence without letters or signs
    bool shortened = false;   ///< only its beginning had room
  };
  Result<Act> Classify(const std::string& sentence, const models::RunOptions& options = {});

 private:
  TokenNetwork network_;
};

/// Names of the file's networks of those kinds whose vocabulary is there; empty: none.
struct TextNetworks {
  std::string encoder, classifier;
  std::vector<std::string> notes;  ///< networks of these kinds that cannot be used, and why
};
TextNetworks FindTextNetworks(const WeightsFile& file);

}  // namespace gestus::features

#endif  // GESTUS_MODELS_FEATURES_WORD_ENCODER_H_
