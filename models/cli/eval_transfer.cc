#include "models/cli/eval_transfer.h"

#include <algorithm>

#include "models/cli/machine.h"
#include "models/metrics/points.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::Arrays;
using outputs::Figure;

Result<std::string> FindClassifier(const Arguments& arguments, const WeightsFile& weights) {
  std::string found;
  for (const fb::Network* network : *weights.root().networks()) {
    if (network->config_type() != fb::Config::ClassifierConfig) continue;
    const std::string name = network->name()->str();
    if (name == arguments.eval.classifier) return name;
    if (!arguments.eval.classifier.empty()) continue;
    if (!found.empty())
      return Status(Code::kInvalidArgument, weights.path() + ": holds several classifiers, " +
                                                found + " and " + name +
                                                ", expected --classifier NAME");
    found = name;
  }
  if (found.empty() && !arguments.eval.classifier.empty())
    return Status(Code::kInvalidArgument, weights.path() + ": has no classifier " +
                                              arguments.eval.classifier +
                                              ", expected one that infer-cli info lists");
  return found;
}

std::vector<std::int64_t> SourcesOf(const std::optional<Figure>& figure) {
  std::vector<std::int64_t> sources;
  if (!figure) return sources;
  for (const outputs::Point& point : figure->points) sources.push_back(point.source);
  return sources;
}

/// Poses and faces side by side, with the points of the predictions in their order.
class MotionArrays {
 public:
  /// Poses alone where that is what the classifier takes.
  MotionArrays(const Sequence& prediction, std::int64_t columns)
      : body_(SourcesOf(prediction.motion.body)), face_(SourcesOf(prediction.motion.face)) {
    if (Columns(body_) == columns) face_.clear();
    fits_ = Columns(body_) + Columns(face_) == columns;
  }

  bool fits() const { return fits_; }
  std::int64_t columns() const { return Columns(body_) + Columns(face_); }

  /// Without frames: a point is missing.
  Array Of(const Sequence& sequence) const {
    Array array;
    array.shape = {0, columns()};
    std::vector<std::size_t> body, face;
    if (!Find(sequence.motion.body, body_, &body) || !Find(sequence.motion.face, face_, &face))
      return array;
    array.shape[0] = sequence.motion.frames;
    for (std::int64_t frame = 0; frame < sequence.motion.frames; ++frame) {
      AddRow(sequence.motion.body, body, frame, &array.f32);
      AddRow(sequence.motion.face, face, frame, &array.f32);
    }
    return array;
  }

 private:
  using Sources = std::vector<std::int64_t>;

  static std::int64_t Columns(const Sources& sources) {
    return 2 * static_cast<std::int64_t>(sources.size());
  }

  static bool Find(const std::optional<Figure>& figure, const Sources& sources,
                   std::vector<std::size_t>* points) {
    if (figure) *points = metrics::PointsWith(*figure, sources);
    return points->size() == sources.size();
  }

  static void AddRow(const std::optional<Figure>& figure, const std::vector<std::size_t>& points,
                     std::int64_t frame, std::vector<float>* row) {
    for (const std::size_t point : points) row->push_back(figure->x(frame, point));
    for (const std::size_t point : points) row->push_back(figure->y(frame, point));
  }

  Sources body_, face_;
  bool fits_ = false;
};

/// Runs the classifier over one sequence; one without all the points is noted.
Status Classify(models::Network* network, const Arguments& arguments, const MotionArrays& arrays,
                const Sequence& sequence, std::vector<std::string>* notes,
                std::optional<metrics::TransferStrength>* strength) {
  if (!*strength) strength->emplace();
  Array motion = arrays.Of(sequence);
  if (motion.shape[0] == 0) {
    if (sequence.motion.frames > 0)
      notes->push_back(sequence.path +
                       ": has not all points that the classifier takes and was not judged");
    return Status();
  }
  models::RunOptions options;
  options.threads = arguments.threads;
  models::RunReport report;
  const Result<Arrays> outputs = network->Run({{"motion", std::move(motion)}}, options, &report);
  if (!outputs.ok()) return outputs.status().In(sequence.path);
  (*strength)->Add(metrics::CountTransferred(outputs->at("strength").f32));
  return Status();
}

Status CountAll(models::Network* network, const Arguments& arguments, const MotionArrays& arrays,
                Material* material, Evaluation* evaluation) {
  Scores& whole = evaluation->pooled;
  for (std::size_t i = 0; i < material->cases.size(); ++i) {
    const Sequence& prediction = *material->cases[i].of[kPrediction];
    auto& strength = evaluation->sequences[i].transfer[kPrediction];
    GESTUS_RETURN_IF_ERROR(
        Classify(network, arguments, arrays, prediction, &material->notes, &strength));
    if (!whole.transfer[kPrediction]) whole.transfer[kPrediction].emplace();
    whole.transfer[kPrediction]->Add(*strength);
  }
  for (const Role role : {kSource, kTarget}) {
    for (const Sequence& sequence : material->sequences[role])
      GESTUS_RETURN_IF_ERROR(
          Classify(network, arguments, arrays, sequence, &material->notes, &whole.transfer[role]));
  }
  return Status();
}

}  // namespace

Result<std::string> AddTransfer(const Arguments& arguments,
                                const std::shared_ptr<const WeightsFile>& weights,
                                Material* material, Evaluation* evaluation) {
  if (weights == nullptr) return std::string();
  Result<std::string> name = FindClassifier(arguments, *weights);
  if (!name.ok() || name->empty()) return name;
  const Result<const kernels::KernelTable*> kernels = ChooseKernels(arguments.isa);
  if (!kernels.ok()) return kernels.status();
  models::NetworkOptions network_options;
  network_options.kernels = *kernels;
  auto network = models::MakeNetwork(weights, *name, network_options);
  if (!network.ok()) return network.status();
  const Sequence& first = *material->cases.front().of[kPrediction];
  const std::int64_t columns = (*network)->signature().inputs.front().shape[1];
  const MotionArrays arrays(first, columns);
  if (!arrays.fits()) {
    const std::string sentence = *name + ": takes " + std::to_string(columns) +
                                 " columns of motion, " + first.path + " has " +
                                 std::to_string(arrays.columns());
    if (!arguments.eval.classifier.empty())
      return Status(Code::kBadInput, sentence + ", expected as many");
    material->notes.push_back(sentence + "; no transfer strength");
    return std::string();
  }
  GESTUS_RETURN_IF_ERROR(CountAll(network->get(), arguments, arrays, material, evaluation));
  return name;
}

}  // namespace gestus::cli
