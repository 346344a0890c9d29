// Which model serves which kind of network.
#include "models/network.h"

#include "models/ast/ast_network.h"
#include "models/autoencoder/autoencoder.h"
#include "models/bert/bert.h"
#include "models/classifier/classifier.h"
#include "models/discriminator/discriminator.h"
#include "models/model1/model1.h"
#include "models/model2/model2.h"
#include "models/zs_mstm/zs_mstm_network.h"
#include "weights_generated.h"

namespace gestus::models {
namespace {

std::string Describe(const std::vector<std::int64_t>& shape, const std::vector<std::string>* axes) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += ", ";
    const bool any = shape[i] == ArraySpec::kAny;
    text += !any                                  ? std::to_string(shape[i])
            : axes != nullptr && i < axes->size() ? (*axes)[i]
                                                  : "any";
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

}  // namespace

Result<std::unique_ptr<Network>> MakeNetwork(std::shared_ptr<const WeightsFile> file,
                                             const std::string& name,
                                             const NetworkOptions& options) {
  const fb::Network* network = file->FindNetwork(name);
  if (network == nullptr) {
    return Status(Code::kNotFound,
                  file->path() + (name.empty() ? ": several networks, expected the name of one"
                                               : ": no network called " + name));
  }
  switch (network->config_type()) {
    case fb::Config::ZsMstm1Config:
    case fb::Config::ZsMstm2Config:
      return MakeZsMstmNetwork(std::move(file), name, options);
    case fb::Config::AstConfig:
      return MakeAstNetwork(std::move(file), name, options);
    case fb::Config::AutoencoderConfig:
      return MakeAutoencoderNetwork(std::move(file), name, options);
    case fb::Config::BertConfig:
      return MakeBertNetwork(std::move(file), name, options);
    case fb::Config::ClassifierConfig:
      return MakeClassifierNetwork(std::move(file), name, options);
    case fb::Config::Model1Config:
      return MakeModel1Network(std::move(file), name, options);
    case fb::Config::Model2Config:
      return MakeModel2Network(std::move(file), name, options);
    case fb::Config::DiscriminatorConfig:
      return MakeDiscriminatorNetwork(std::move(file), name, options);
    default:
      break;
  }
  return Status(Code::kBadWeights, file->path() + ": network of a kind this version does not know");
}

Status CheckArray(const ArraySpec& spec, const Array& array) {
  bool fits = array.dtype == spec.dtype && array.shape.size() == spec.shape.size();
  for (std::size_t i = 0; fits && i < spec.shape.size(); ++i)
    fits = spec.shape[i] == ArraySpec::kAny ? array.shape[i] > 0 : array.shape[i] == spec.shape[i];
  if (fits) {
    std::size_t elements = 1;
    for (std::int64_t d : array.shape) elements *= static_cast<std::size_t>(d);
    const std::size_t held = array.dtype == DType::kI32 ? array.i32.size() : array.f32.size();
    if (held == elements) return {};
    return Status(Code::kBadInput, spec.name + ": " + std::to_string(held) +
                                       " elements, expected those of " +
                                       Describe(array.shape, nullptr));
  }
  return Status(Code::kBadInput, spec.name + ": " + Describe(array.shape, nullptr) + " " +
                                     Name(array.dtype) + ", expected " +
                                     Describe(spec.shape, &spec.axes) + " " + Name(spec.dtype));
}

}  // namespace gestus::models
