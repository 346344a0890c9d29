// Errors as values: a Status is a code and one sentence that says what was wrong, where, what was
// expected and found.  Result<T> is a T or the Status that stands in its place.
#ifndef GESTUS_ENGINE_STATUS_H_
#define GESTUS_ENGINE_STATUS_H_

#include <string>
#include <utility>
#include <variant>

namespace gestus {

enum class Code {
  kOk,
  kInvalidArgument,    ///< the caller asked for something that makes no sense
  kNotFound,           ///< no such file, tensor or array
  kBadWeights,         ///< a weights file that is damaged, foreign or inconsistent
  kBadInput,           ///< an input array or file that does not fit
  kIo,                 ///< the operating system refused
  kResourceExhausted,  ///< a limit on memory or size
  kNonFinite,          ///< NaN or infinity in a result
};

class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Code code, std::string message) : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == Code::kOk; }
  explicit operator bool() const { return ok(); }
  Code code() const { return code_; }
  /// One sentence, without a final newline; empty when ok.
  const std::string& message() const& { return message_; }
  std::string message() && { return std::move(message_); }

  /// The same error with "where: " put before its sentence.
  Status In(const std::string& where) const {
    return ok() ? *this : Status(code_, where + ": " + message_);
  }

 private:
  Code code_ = Code::kOk;
  std::string message_;
};

/// A file or an array is not as it should be.
inline Status BadInput(std::string sentence) {
  return Status(Code::kBadInput, std::move(sentence));
}

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}         // NOLINT: implicit by design
  Result(Status status) : state_(std::move(status)) {}  // NOLINT: implicit by design

  bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  Status status() const { return ok() ? Status() : std::get<Status>(state_); }

  T& operator*() & { return *std::get_if<T>(&state_); }
  const T& operator*() const& { return *std::get_if<T>(&state_); }
  T&& operator*() && { return std::move(*std::get_if<T>(&state_)); }
  T* operator->() { return std::get_if<T>(&state_); }
  const T* operator->() const { return std::get_if<T>(&state_); }

 private:
  std::variant<T, Status> state_;
};

}  // namespace gestus

/// Leaves the enclosing function with the Status of `expr` when that is an error.
#define GESTUS_RETURN_IF_ERROR(expr)                                                           \
  do {                                                                                         \
    if (::gestus::Status gestus_status_ = (expr); !gestus_status_.ok()) return gestus_status_; \
  } while (false)

#endif  // GESTUS_ENGINE_STATUS_H_
