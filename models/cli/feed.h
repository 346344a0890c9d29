// What a run is fed with: arrays from a file, or what the front end makes of recordings and words.
#ifndef GESTUS_MODELS_CLI_FEED_H_
#define GESTUS_MODELS_CLI_FEED_H_

#include <memory>

#include "engine/status.h"
#include "models/cli/args.h"
#include "models/cli/inputs.h"
#include "models/cli/setup.h"
#include "models/features/front_end.h"
#include "models/network.h"

namespace gestus::cli {

struct Feed {
  std::unique_ptr<features::FrontEnd> front_end;  ///< outlives the stream
  std::unique_ptr<features::InputStream> stream;
  models::Arrays arrays;  ///< what INPUT holds ready-made
  models::Arrays style;   ///< of --style: "style", or a clip
  features::Account account;
  std::vector<std::string> style_used;  ///< as account.used, of --style
  bool only_arrays = false;             ///< the stream is `arrays` and has one stretch
};

/// Opens everything that the command line names, for the network in `setup`.
Result<Feed> OpenFeed(const Arguments& arguments, const Inputs& inputs, const Setup& setup);

/// The arrays of a style: a .style file, a clip (.npz), or a speaker's recording, words and poses.
Status ReadStyle(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                 features::FrontEnd* front_end, features::Account* account, models::Arrays* arrays);

/// The same, but no .style file.
Status ReadClip(const Arguments& arguments, const Inputs& inputs, const Setup& setup,
                features::FrontEnd* front_end, features::Account* account, models::Arrays* arrays);

/// Chooses among the networks of a file by what `inputs` can be made into.
Result<Setup> OpenNetworkFor(const Arguments& arguments, const Inputs& inputs);

}  // namespace gestus::cli

#endif  // GESTUS_MODELS_CLI_FEED_H_
