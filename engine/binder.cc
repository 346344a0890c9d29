// Looks tensors up by name and compares their shapes.
#include "engine/binder.h"

namespace gestus {

void Binder::Bind(std::initializer_list<Entry> table) {
  for (const Entry& e : table) {
    if (!status_.ok()) return;
    const std::string name = prefix_ + e.name;
    const WeightsFile::Entry* found = file_.Find(name);
    if (found == nullptr) {
      status_ = Status(Code::kBadWeights, file_.path() + ": tensor " + name +
                                              ": missing, expected " + e.shape.ToString());
    } else if (!(found->view.shape == e.shape) || found->view.dtype != DType::kF32) {
      status_ =
          Status(Code::kBadWeights,
                 file_.path() + ": tensor " + name + ": " + found->view.shape.ToString() + " " +
                     Name(found->view.dtype) + ", expected " + e.shape.ToString() + " float32");
    } else {
      *e.to = found->view;
      used_.insert(name);
    }
  }
}

const WeightsFile::Entry* Binder::Use(const std::string& full_name) {
  used_.insert(full_name);
  return file_.Find(full_name);
}

Status Binder::Finish() const {
  if (!status_.ok()) return status_;
  for (const WeightsFile::Entry& e : file_.tensors()) {
    if (e.name.compare(0, prefix_.size(), prefix_) == 0 && used_.count(e.name) == 0)
      return Status(Code::kBadWeights, file_.path() + ": tensor " + e.name +
                                           ": not part of this network, expected none");
  }
  return {};
}

}  // namespace gestus
