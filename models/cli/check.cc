// The computation on this machine against the result that the file's maker recorded.
#include "models/cli/check.h"

#include "models/cli/json.h"
#include "models/cli/machine.h"
#include "models/cli/setup.h"
#include "models/io/text.h"
#include "models/self_test.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

struct Checked {
  std::string network, kind;
  models::SelfTestReport report;
};

std::string Verdict(const models::SelfTestReport& r) {
  return !r.present ? "no self-test" : r.passed() ? "passed" : "missed";
}

std::string CheckText(const std::vector<Checked>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const Checked& c : all) {
    rows.push_back({c.network, c.kind, Verdict(c.report)});
    if (!c.report.present) continue;
    rows.back().push_back("relative error " + Significant(c.report.relative_error, 2) +
                          ", expected at most " + Significant(c.report.tolerance, 2));
  }
  return Table(rows, {}, "");
}

std::string CheckJson(const std::vector<Checked>& all, const char* isa) {
  JsonWriter json;
  json.BeginObject().Member("isa", isa).Key("networks").BeginArray();
  for (const Checked& c : all) {
    json.BeginObject().Member("name", c.network).Member("kind", c.kind);
    json.Member("self_test", Verdict(c.report));
    if (c.report.present)
      json.Member("relative_error", c.report.relative_error)
          .Member("tolerance", c.report.tolerance);
    json.EndObject();
  }
  json.EndArray().EndObject();
  return json.text();
}

}  // namespace

Status RunCheck(const Arguments& arguments) {
  const Result<const kernels::KernelTable*> kernels = ChooseKernels(arguments.isa);
  if (!kernels.ok()) return kernels.status();
  const Result<std::shared_ptr<const WeightsFile>> weights = WeightsFile::Open(arguments.weights);
  if (!weights.ok()) return weights.status();
  std::vector<Checked> all;
  Status missed;
  for (const fb::Network* stored : *(*weights)->root().networks()) {
    const std::string name = stored->name()->str();
    if (!arguments.network.empty() && arguments.network != name) continue;
    auto network = models::MakeNetwork(*weights, name, {.kernels = *kernels});
    if (!network.ok()) return network.status();
    const Result<models::SelfTestReport> report =
        models::RunSelfTest(**weights, name, **network, {.threads = arguments.threads});
    if (!report.ok()) return report.status();
    if (report->present && !report->passed() && missed.ok())
      missed = Status(Code::kBadWeights,
                      arguments.weights + ": self-test of " + name + ": relative error " +
                          Significant(report->relative_error, 2) + ", expected at most " +
                          Significant(report->tolerance, 2));
    all.push_back({name, (*network)->kind(), *report});
  }
  if (all.empty())
    return Status(Code::kNotFound, arguments.weights + ": no network " + arguments.network +
                                       ", expected one that infer-cli info lists");
  GESTUS_RETURN_IF_ERROR(
      Print(arguments.json ? CheckJson(all, kernels::IsaName((*kernels)->isa)) : CheckText(all)));
  return missed;
}

}  // namespace gestus::cli
