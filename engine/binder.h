// Binds the tensors of a weights file to the fields of a network's weights, by table:
//
//   binder.Bind({{"norm1.weight", &w.norm1.gamma, {d}},
//                {"norm1.bias", &w.norm1.beta, {d}}});
//
// Missing, misshapen and left-over tensors are errors that name tensor, expected and found.
#ifndef GESTUS_ENGINE_BINDER_H_
#define GESTUS_ENGINE_BINDER_H_

#include <initializer_list>
#include <set>
#include <string>

#include "engine/status.h"
#include "engine/weights_file.h"

namespace gestus {

class Binder {
 public:
  /// What reads a tensor: values want float32, products and embeddings take bfloat16 and int8 too.
  enum Reader : std::uint8_t { kValues, kProduct };
  struct Entry {
    std::string name;  ///< after the current prefix
    TensorView* to;
    Shape shape;
    Reader reader = kValues;
  };

  Binder(const WeightsFile& file, std::string prefix) : file_(file), prefix_(std::move(prefix)) {}

  void Bind(std::initializer_list<Entry> table);
  /// Adds to the prefix for the lifetime of the object.
  class Scope {
   public:
    Scope(Binder& binder, const std::string& name)
        : binder_(binder), length_(binder.prefix_.size()) {
      binder.prefix_ += name;
    }
    ~Scope() { binder_.prefix_.resize(length_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Binder& binder_;
    std::size_t length_;
  };

  const WeightsFile& file() const { return file_; }
  /// Marks a tensor as used without binding it; a self-test's arrays, for instance.
  const WeightsFile::Entry* Use(const std::string& full_name);
  /// The first mistake, or a tensor below the current prefix that nothing has bound.
  Status Finish() const;
  const Status& status() const { return status_; }

 private:
  const WeightsFile& file_;
  std::string prefix_;
  std::set<std::string> used_;
  Status status_;
};

}  // namespace gestus

#endif  // GESTUS_ENGINE_BINDER_H_
