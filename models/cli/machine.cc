// Asks the kernels' dispatch what runs here, and puts refusals into words.
#include "models/cli/machine.h"

#include <cstdlib>

#include "models/cli/json.h"

namespace gestus::cli {
namespace {

using kernels::Isa;

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "gcc " __VERSION__;
#endif

std::string Join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

std::vector<std::string> AvailableIsas() {
  std::vector<std::string> names;
  for (const Isa isa : kernels::kAllIsas) {
    if (kernels::TableFor(isa) != nullptr) names.push_back(kernels::IsaName(isa));
  }
  return names;
}

Result<const kernels::KernelTable*> ChooseKernels(const std::string& isa) {
  if (isa.empty()) return &kernels::BestTable();
  Isa wanted = Isa::kScalar;
  const bool known = kernels::ParseIsa(isa.c_str(), &wanted);
  const kernels::KernelTable* table = known ? kernels::TableFor(wanted) : nullptr;
  if (table != nullptr) return table;
  return Status(Code::kInvalidArgument,
                "--isa: " + isa + (known ? " does not run on this machine" : " is unknown") +
                    ", expected one of " + Join(AvailableIsas()));
}

std::string IgnoredIsaNote() {
  const char* wish = std::getenv("GESTUS_ISA");
  if (wish == nullptr || *wish == '\0' || ChooseKernels(wish).ok()) return "";
  return "GESTUS_ISA=" + std::string(wish) + " is ignored: this machine has " +
         Join(AvailableIsas());
}

std::string VersionText() {
  return std::string("infer-cli (gestus) ") + GESTUS_VERSION + "\n  instruction set  " +
         kernels::BestTable().name + " (available: " + Join(AvailableIsas()) +
         ")\n  compiler         " + kCompiler + "\n";
}

std::string VersionJson() {
  JsonWriter json;
  json.BeginObject()
      .Member("version", GESTUS_VERSION)
      .Member("isa", kernels::BestTable().name)
      .Member("available_isas", AvailableIsas())
      .Member("compiler", kCompiler)
      .EndObject();
  return json.text();
}

}  // namespace gestus::cli
