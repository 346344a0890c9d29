// Loads the weights named on the command line and generates one segment from silence.
#include <cstdio>
#include <vector>

#include "models/zs_mstm/zs_mstm.h"

int main(int argc, char** argv) {
  using namespace gestus;
  if (argc != 2) return 2;
  const auto file = WeightsFile::Open(argv[1], {.residence = Residence::kCopied});
  if (!file.ok()) return std::fprintf(stderr, "%s\n", file.status().message().c_str()), 1;
  const auto model = models::ZsMstm::Make(*file, "");
  if (!model.ok()) return std::fprintf(stderr, "%s\n", model.status().message().c_str()), 1;
  const auto agent = models::ZsMstm::NewAgent(*model, {.threads = 1});
  if (!agent.ok()) return std::fprintf(stderr, "%s\n", agent.status().message().c_str()), 1;

  const models::ZsMstmConfig& c = (*model)->config();
  const auto zeros = [&](std::int64_t cols) {
    return std::vector<float>(static_cast<std::size_t>(c.WindowFrames() * cols));
  };
  const auto speech = zeros(c.ast_content.mel_bins), text = zeros(c.d_text);
  auto pose = zeros(c.d_pose);
  (*agent)->AddStyleSegment({speech.data(), text.data(), pose.data()});
  (*agent)->Generate(speech.data(), text.data(), pose.data());
  std::printf("%zu values, first %g\n", pose.size(), static_cast<double>(pose[0]));
}
