// Looks tensors up by name and compares their shapes.
#include "engine/binder.h"

namespace gestus {
namespace {

bool Takes(Binder::Reader reader, DType dtype) {
  if (dtype == DType::kF32) return true;
  return reader == Binder::kProduct && (dtype == DType::kBF16 || dtype == DType::kI8);
}

}  // namespace

void Binder::Bind(std::initializer_list<Entry> table) {
  for (const Entry& e : table) {
    if (!status_.ok()) return;
    const std::string name = prefix_ + e.name;
    const WeightsFile::Entry* found = file_.Find(name);
    if (found == nullptr) {
      status_ = Status(Code::kBadWeights, file_.path() + ": tensor " + name +
                                              ": missing, expected " + e.shape.ToString());
    } else if (!(found->view.shape == e.shape) || !Takes(e.reader, found->view.dtype)) {
      const char* types = e.reader == kProduct ? " float32, bfloat16 or int8" : " float32";
      status_ =
          Status(Code::kBadWeights,
                 file_.path() + ": tensor " + name + ": " + found->view.shape.ToString() + " " +
                     Name(found->view.dtype) + ", expected " + e.shape.ToString() + types);
    } else {
      if (found->view.dtype == DType::kI8) used_.insert(found->scale);
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
