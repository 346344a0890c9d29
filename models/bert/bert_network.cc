// BERT on sequences of word pieces of any length.
#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>

#include "engine/plan.h"
#include "models/bert/bert.h"
#include "models/config.h"
#include "models/run_support.h"
#include "models/self_test.h"
#include "weights_generated.h"

namespace gestus::models {

Result<BertConfig> ReadBertConfig(const fb::BertConfig& f, const std::string& where) {
  ConfigReader read(where);
  BertConfig c;
  c.layers = read.Size("layers", f.layers(), 1, 256);
  c.d_model = read.Size("d_model", f.d_model(), 1, 1 << 14);
  c.heads = read.Divisor("heads", f.heads(), c.d_model, "d_model");
  c.d_mlp = read.Size("d_mlp", f.d_mlp(), 1, 1 << 16);
  c.tokens = read.Size("tokens", f.tokens(), 1, 1 << 24);
  c.positions = read.Size("positions", f.positions(), 3, 1 << 14);
  c.types = read.Size("types", f.types(), 0, 64);
  c.ln_eps = read.Epsilon("ln_eps", f.ln_eps());
  c.head = read.Enum<BertHead>("head", f.head(), fb::BertHead::MAX);
  if (f.labels() != nullptr) {
    for (const flatbuffers::String* label : *f.labels()) c.labels.push_back(label->str());
  }
  const bool classifies = c.head == BertHead::kClassifier;
  if (classifies != !c.labels.empty())
    read.Fail("labels", std::to_string(c.labels.size()),
              classifies ? "one for each class" : "none without a classifier");
  if (!read.status().ok()) return read.status();
  return c;
}

namespace {

/// The line of `vocabulary` that is `token`, or -1.
std::int32_t LineOf(std::string_view vocabulary, std::string_view token) {
  std::int32_t line = 0;
  for (std::size_t at = 0; at <= vocabulary.size(); ++line) {
    const std::size_t end = std::min(vocabulary.find('\n', at), vocabulary.size());
    std::string_view text = vocabulary.substr(at, end - at);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text == token) return line;
    at = end + 1;
  }
  return -1;
}

class BertNetwork final : public Network {
 public:
  BertNetwork(std::shared_ptr<const WeightsFile> file, const NetworkOptions& options)
      : file_(std::move(file)),
        cache_(options.kernels != nullptr ? *options.kernels : kernels::BestTable(), file_),
        max_arena_bytes_(options.max_arena_bytes) {}

  Status Init(const fb::Network& record, bool planned);
  const char* kind() const override {
    return c_.head == BertHead::kClassifier ? "BERT with a classifier" : "BERT";
  }
  const Signature& signature() const override { return signature_; }
  std::string PlanText() const override { return longest_ == nullptr ? "" : longest_->ToString(); }
  Result<Arrays> Run(const Arrays& inputs, const RunOptions& options, RunReport* report) override;

 private:
  struct Sequence {
    const std::int32_t* ids;
    std::int64_t length;
  };
  using Sessions = std::map<std::int64_t, std::unique_ptr<Session>>;

  Status ReadVocabulary(const fb::Network& record, Binder& binder);
  Signature Describe() const;
  Result<std::shared_ptr<const Plan>> MakePlan(std::int64_t length, bool taps);
  Result<std::vector<Sequence>> Cut(const Array& ids) const;
  Result<Session*> SessionFor(std::int64_t length, const RunOptions& options, Sessions* sessions);

  std::shared_ptr<const WeightsFile> file_;
  WeightCache cache_;
  std::uint64_t max_arena_bytes_;
  BertConfig c_;
  BertWeights w_;
  Signature signature_;
  std::shared_ptr<const Plan> longest_;
};

Status BertNetwork::Init(const fb::Network& record, bool planned) {
  Result<BertConfig> config =
      ReadBertConfig(*record.config_as_BertConfig(), "network " + record.name()->str());
  if (!config.ok()) return config.status().In(file_->path());
  c_ = *std::move(config);
  Binder binder(*file_, record.prefix()->str());
  BindBert(binder, c_, &w_);
  GESTUS_RETURN_IF_ERROR(ReadVocabulary(record, binder).In(file_->path()));
  UseSelfTest(binder, record);
  GESTUS_RETURN_IF_ERROR(binder.Finish());
  signature_ = Describe();
  if (!planned) return {};
  auto plan = MakePlan(c_.positions, false);
  if (!plan.ok()) return plan.status();
  longest_ = *std::move(plan);
  return {};
}

Status BertNetwork::ReadVocabulary(const fb::Network& record, Binder& binder) {
  const std::string name = record.prefix()->str() + "vocabulary";
  if (const WeightsFile::Entry* entry = binder.Use(name); entry != nullptr) {
    if (entry->view.dtype != DType::kU8)
      return Status(Code::kBadWeights, "tensor " + name + ": expected uint8, tokens by line");
    const std::string_view text(static_cast<const char*>(entry->view.data), entry->bytes);
    c_.cls = LineOf(text, "[CLS]");
    c_.sep = LineOf(text, "[SEP]");
  }
  if (c_.cls < 0 || c_.sep < 0 || std::max(c_.cls, c_.sep) >= c_.tokens)
    return Status(Code::kBadWeights, "network " + record.name()->str() +
                                         ": no tokens [CLS] and [SEP] among the " +
                                         std::to_string(c_.tokens) + " of the vocabulary");
  return {};
}

Signature BertNetwork::Describe() const {
  constexpr std::int64_t kAny = ArraySpec::kAny;
  ArraySpec ids = Spec("ids", {kAny, kAny}, {"sequences", "pieces"}, "tokens",
                       "word pieces without [CLS] and [SEP], zeros behind the end");
  ids.dtype = DType::kI32;
  if (c_.head == BertHead::kNone)
    return {{ids},
            {Spec("hidden", {kAny, kAny, c_.d_model}, {"sequences", "pieces", "features"}, "-",
                  "X_text: the last layer at every piece, zeros behind the end")}};
  const auto labels = static_cast<std::int64_t>(c_.labels.size());
  ArraySpec act = Spec("act", {kAny}, {"sequences"}, "index into labels", "the likeliest class");
  act.dtype = DType::kI32;
  return {{ids},
          {Spec("probabilities", {kAny, labels}, {"sequences", "classes"}, "0 to 1",
                "of each class, in the order of labels"),
           act}};
}

Result<std::shared_ptr<const Plan>> BertNetwork::MakePlan(std::int64_t length, bool taps) {
  Graph g;
  const Value hidden = Bert(g, c_, w_, g.Input("ids", {length}, DType::kI32));
  if (c_.head == BertHead::kClassifier)
    g.Output("probabilities", BertClassifier(g, w_, hidden));
  else
    g.Output("hidden", hidden);
  auto plan = Plan::Make(std::move(g), cache_, {.taps = taps, .max_arena_bytes = max_arena_bytes_});
  if (!plan.ok()) return plan.status().In(file_->path());
  return plan;
}

Result<std::vector<BertNetwork::Sequence>> BertNetwork::Cut(const Array& ids) const {
  const std::int64_t rows = ids.shape[0], cols = ids.shape[1];
  std::vector<Sequence> sequences;
  for (std::int64_t row = 0; row < rows; ++row) {
    const std::int32_t* begin = ids.i32.data() + row * cols;
    std::int64_t length = cols;
    while (length > 0 && begin[length - 1] == 0) --length;
    for (std::int64_t i = 0; i < length; ++i) {
      if (begin[i] >= 0 && begin[i] < c_.tokens) continue;
      return Status(Code::kBadInput, "ids: " + std::to_string(begin[i]) + " at row " +
                                         std::to_string(row) + ", column " + std::to_string(i) +
                                         ", expected 0 to " + std::to_string(c_.tokens - 1));
    }
    if (c_.head == BertHead::kClassifier && length > c_.MaxPieces())
      return Status(Code::kBadInput, "ids: " + std::to_string(length) + " pieces in row " +
                                         std::to_string(row) + ", expected at most " +
                                         std::to_string(c_.MaxPieces()) + " in one sentence");
    sequences.push_back({begin, length});
  }
  return sequences;
}

Result<Session*> BertNetwork::SessionFor(std::int64_t length, const RunOptions& options,
                                         Sessions* sessions) {
  std::unique_ptr<Session>& session = (*sessions)[length];
  if (session == nullptr) {
    auto plan = MakePlan(length, options.taps);
    if (!plan.ok()) return plan.status();
    auto made = Session::Create(*plan, SessionOptionsOf(options));
    if (!made.ok()) return made.status();
    session = *std::move(made);
  }
  return session.get();
}

Result<Arrays> BertNetwork::Run(const Arrays& inputs, const RunOptions& options,
                                RunReport* report) {
  if (longest_ == nullptr) return NotPlanned();
  GESTUS_RETURN_IF_ERROR(CheckOptions(options));
  GESTUS_RETURN_IF_ERROR(CheckInputs(signature_, inputs));
  const Array& ids = inputs.at("ids");
  const Result<std::vector<Sequence>> sequences = Cut(ids);
  if (!sequences.ok()) return sequences.status();

  const bool classifies = c_.head == BertHead::kClassifier;
  const std::int64_t rows = ids.shape[0], cols = ids.shape[1];
  const auto labels = static_cast<std::int64_t>(c_.labels.size());
  Array result = MakeArray(classifies ? std::vector<std::int64_t>{rows, labels}
                                      : std::vector<std::int64_t>{rows, cols, c_.d_model});
  Array act = MakeArray({rows}, DType::kI32);
  Sessions sessions;
  Session* last = nullptr;
  Progress progress{0, static_cast<std::size_t>(rows)};
  for (std::int64_t row = 0; row < rows; ++row) {
    const Sequence& s = (*sequences)[static_cast<std::size_t>(row)];
    // A sentence without words still has a class; it has no hidden states to give.
    for (std::int64_t at = 0; at < s.length || (classifies && at == 0); at += c_.MaxPieces()) {
      const std::int64_t n = std::min(s.length - at, c_.MaxPieces());
      const Result<Session*> session = SessionFor(n + 2, options, &sessions);
      if (!session.ok()) return session.status();
      last = *session;
      std::int32_t* in = last->Input("ids").i32;
      in[0] = c_.cls;
      std::copy_n(s.ids + at, n, in + 1);
      in[n + 1] = c_.sep;
      TimedRun(options, report, [&] { last->Run(); });
      if (classifies) {
        float* to = result.f32.data() + row * labels;
        CopyOut(to, last->Output("probabilities"));
        act.i32[static_cast<std::size_t>(row)] =
            static_cast<std::int32_t>(std::max_element(to, to + labels) - to);
      } else {
        const ValueView hidden = last->Output("hidden");
        std::memcpy(result.f32.data() + (row * cols + at) * c_.d_model,
                    hidden.f32 + hidden.row_stride,
                    static_cast<std::size_t>(n * c_.d_model) * sizeof(float));
      }
    }
    if (!classifies && s.length > c_.MaxPieces())
      AddNote(report, "ids: row " + std::to_string(row) + " has " + std::to_string(s.length) +
                          " pieces; they ran in chunks of at most " +
                          std::to_string(c_.MaxPieces()) + " that do not see one another");
    progress.Step(options);
  }
  const char* name = classifies ? "probabilities" : "hidden";
  GESTUS_RETURN_IF_ERROR(CheckFinite(name, result, Code::kNonFinite));
  Arrays outputs;
  outputs[name] = std::move(result);
  if (classifies) outputs["act"] = std::move(act);
  if (options.taps && last != nullptr) CopyTaps(*last, &outputs);
  for (const auto& [length, session] : sessions) AddProfiles({session.get()}, report);
  return outputs;
}

}  // namespace

Result<std::unique_ptr<Network>> MakeBertNetwork(std::shared_ptr<const WeightsFile> file,
                                                 const std::string& name,
                                                 const NetworkOptions& options) {
  const fb::Network& record = *file->FindNetwork(name);
  auto network = std::make_unique<BertNetwork>(std::move(file), options);
  GESTUS_RETURN_IF_ERROR(network->Init(record, options.plan));
  return std::unique_ptr<Network>(std::move(network));
}

}  // namespace gestus::models
