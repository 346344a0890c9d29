// A network that is one graph of a fixed shape, run once for each item of its input: a segment, a
// word, a sequence.  A model says how it is loaded, declared and fed; the rest is the same for all.
#ifndef GESTUS_MODELS_GRAPH_NETWORK_H_
#define GESTUS_MODELS_GRAPH_NETWORK_H_

#include <memory>
#include <string>

#include "engine/binder.h"
#include "engine/plan.h"
#include "engine/session.h"
#include "models/network.h"
#include "models/run_support.h"

namespace gestus::fb {
struct Network;
}

namespace gestus::models {

class GraphNetwork : public Network {
 public:
  const Signature& signature() const final { return signature_; }
  std::string PlanText() const final { return plan_ == nullptr ? "" : plan_->ToString(); }
  Result<Arrays> Run(const Arrays& inputs, const RunOptions& options, RunReport* report) final;

  /// Loads `network`, which has just been made empty, from its record in `file`, and plans it.
  template <class T>
  static Result<std::unique_ptr<Network>> Make(std::shared_ptr<const WeightsFile> file,
                                               const std::string& name,
                                               const NetworkOptions& options) {
    auto network = std::make_unique<T>();
    GESTUS_RETURN_IF_ERROR(network->Init(std::move(file), name, options));
    return std::unique_ptr<Network>(std::move(network));
  }

 protected:
  /// What RunItems has at hand besides its arrays.
  struct Items {
    Session& session;
    const RunOptions& options;
    RunReport* report;
    Progress progress;

    /// Runs the session for one item, as often as the options say.
    void Run();
  };

  /// Reads the configuration and binds the tensors.
  virtual Status Load(const fb::Network& record, Binder& binder) = 0;
  virtual Signature Describe() const = 0;
  virtual Graph Declare() const = 0;
  /// The usual RunItems: `input` cut into windows of `length` rows, each of which makes one row of
  /// `output`.
  static void RunWindows(const Array& input, const std::string& input_name, std::int64_t length,
                         const std::string& output_name, Items& items, Arrays* outputs);
  /// Feeds the session item by item; `inputs` fit the signature, results are checked by the caller.
  virtual Status RunItems(const Arrays& inputs, Items& items, Arrays* outputs) = 0;

 private:
  Status Init(std::shared_ptr<const WeightsFile> file, const std::string& name,
              const NetworkOptions& options);
  Result<std::shared_ptr<const Plan>> MakePlan(bool taps);

  std::shared_ptr<const WeightsFile> file_;
  std::unique_ptr<WeightCache> cache_;
  std::uint64_t max_arena_bytes_ = 0;
  Signature signature_;
  std::shared_ptr<const Plan> plan_;
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_GRAPH_NETWORK_H_
