#include "models/features/word_encoder.h"

#include <algorithm>
#include <numeric>

#include "weights_generated.h"

namespace gestus::features {
namespace {

std::string VocabularyName(const fb::Network& network) {
  return network.prefix()->str() + "vocabulary";
}

}  // namespace

std::vector<float> Pieces::WordMeans() const {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<float> means(counts.size() * columns);
  const float* piece = rows.data();
  for (std::size_t word = 0; word < counts.size(); ++word) {
    float* mean = means.data() + word * columns;
    for (std::int64_t n = 0; n < counts[word]; ++n, piece += columns) {
      for (std::size_t i = 0; i < columns; ++i)
        mean[i] += piece[i] / static_cast<float>(counts[word]);
    }
  }
  return means;
}

Result<models::WordPiece> ReadTokeniser(const WeightsFile& file, const fb::Network& network) {
  const std::string where = file.path() + ": network " + network.name()->str();
  if (network.config_type() != fb::Config::BertConfig)
    return Status(Code::kNotFound, where + ": is no BERT, expected one");
  const fb::BertConfig& config = *network.config_as_BertConfig();
  const WeightsFile::Entry* entry = file.Find(VocabularyName(network));
  if (entry == nullptr)
    return Status(Code::kNotFound,
                  where + ": no vocabulary, expected the tensor " + VocabularyName(network));
  auto words =
      models::WordPiece::Make(std::string(static_cast<const char*>(entry->view.data), entry->bytes),
                              {.lower_case = config.lower_case()});
  if (!words.ok()) return words.status().In(where);
  if (words->vocabulary().size() > static_cast<std::int32_t>(config.tokens()))
    return Status(Code::kBadWeights,
                  where + ": vocabulary has " + std::to_string(words->vocabulary().size()) +
                      " tokens, expected at most " + std::to_string(config.tokens()));
  return words;
}

Result<TokenNetwork> TokenNetwork::Make(std::shared_ptr<const WeightsFile> file,
                                        const std::string& name,
                                        const models::NetworkOptions& options) {
  const fb::Network* record = file->FindNetwork(name);
  if (record == nullptr)
    return Status(Code::kNotFound, file->path() + ": no network called " + name);
  Result<models::WordPiece> words = ReadTokeniser(*file, *record);
  if (!words.ok()) return words.status();
  TokenNetwork result;
  result.words_ = std::make_shared<const models::WordPiece>(*std::move(words));
  auto network = models::MakeNetwork(file, name, options);
  if (!network.ok()) return network.status();
  result.network_ = *std::move(network);
  const fb::BertConfig& config = *record->config_as_BertConfig();
  result.max_tokens_ = std::int64_t{config.positions()} - 2;
  result.width_ = config.d_model();
  if (config.labels() != nullptr) {
    for (const flatbuffers::String* label : *config.labels())
      result.labels_.push_back(label->str());
  }
  return result;
}

Result<models::Arrays> TokenNetwork::Run(const std::vector<std::int32_t>& ids,
                                         const models::RunOptions& options) {
  models::Array array;
  array.dtype = DType::kI32;
  array.shape = {1, static_cast<std::int64_t>(ids.size())};
  array.i32 = ids;
  return network_->Run({{"ids", std::move(array)}}, options, nullptr);
}

Result<Pieces> WordEncoder::Encode(const std::vector<std::string>& words,
                                   const models::RunOptions& options) {
  PieceRows all(this, words);
  Pieces pieces;
  pieces.width = width();
  pieces.counts = all.counts();
  const std::int64_t total =
      std::accumulate(pieces.counts.begin(), pieces.counts.end(), std::int64_t{0});
  pieces.rows.reserve(static_cast<std::size_t>(total * width()));
  for (std::int64_t piece = 0; piece < total; ++piece) {
    const Result<const float*> row = all.Row(piece, options);
    if (!row.ok()) return row.status();
    pieces.rows.insert(pieces.rows.end(), *row, *row + width());
  }
  return pieces;
}

PieceRows::PieceRows(WordEncoder* encoder, const std::vector<std::string>& words)
    : encoder_(encoder) {
  for (const std::string& word : words) {
    const std::vector<models::Token> tokens = encoder->network_.words().Tokenise(word);
    counts_.push_back(static_cast<std::int64_t>(tokens.size()));
    for (const models::Token& token : tokens) ids_.push_back(token.id);
  }
}

Result<const float*> PieceRows::Row(std::int64_t piece, const models::RunOptions& options) {
  const std::int64_t size = encoder_->network_.max_tokens();
  if (piece / size != chunk_) {
    const std::int64_t begin = piece / size * size;
    const auto end = std::min(begin + size, static_cast<std::int64_t>(ids_.size()));
    Result<models::Arrays> outputs =
        encoder_->network_.Run({ids_.begin() + begin, ids_.begin() + end}, options);
    if (!outputs.ok()) return outputs.status();
    rows_ = std::move(outputs->at("hidden").f32);
    chunk_ = piece / size;
  }
  return rows_.data() + piece % size * encoder_->width();
}

Result<ActClassifier::Act> ActClassifier::Classify(const std::string& sentence,
                                                   const models::RunOptions& options) {
  Act act;
  const std::vector<models::Token> tokens = network_.words().Tokenise(sentence);
  if (tokens.empty()) return act;
  const auto most = static_cast<std::size_t>(network_.max_tokens());
  act.shortened = tokens.size() > most;
  std::vector<std::int32_t> ids;
  for (std::size_t i = 0; i < std::min(tokens.size(), most); ++i) ids.push_back(tokens[i].id);
  Result<models::Arrays> outputs = network_.Run(ids, options);
  if (!outputs.ok()) return outputs.status();
  act.label = outputs->at("act").i32.front();
  return act;
}

TextNetworks FindTextNetworks(const WeightsFile& file) {
  TextNetworks found;
  for (const fb::Network* network : *file.root().networks()) {
    if (network->config_type() != fb::Config::BertConfig) continue;
    const std::string name = network->name()->str();
    const bool classifies = network->config_as_BertConfig()->head() == fb::BertHead::Classifier;
    std::string& place = classifies ? found.classifier : found.encoder;
    if (file.Find(VocabularyName(*network)) == nullptr) {
      found.notes.push_back("network " + name +
                            " has no vocabulary, so no words can be given to it");
    } else if (place.empty()) {
      place = name;
    } else {
      found.notes.push_back("network " + name + " was not used, " + place + " is of the same kind");
    }
  }
  return found;
}

}  // namespace gestus::features
