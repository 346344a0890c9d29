// Reads typed configurations with a range for every field; the first field out of range is the
// reader's status.
#ifndef GESTUS_MODELS_CONFIG_H_
#define GESTUS_MODELS_CONFIG_H_

#include <algorithm>
#include <cstdint>
#include <string>

#include "engine/status.h"

namespace gestus::models {

class ConfigReader {
 public:
  explicit ConfigReader(std::string where) : where_(std::move(where)) {}

  std::int64_t Size(const char* field, std::int64_t value, std::int64_t low, std::int64_t high) {
    if (value < low || value > high)
      Fail(field, std::to_string(value), std::to_string(low) + " to " + std::to_string(high));
    return std::clamp(value, low, std::max(low, high));
  }

  /// A count that divides `whole`.
  std::int64_t Divisor(const char* field, std::int64_t value, std::int64_t whole,
                       const char* whole_name) {
    if (value < 1 || whole % value != 0)
      Fail(field, std::to_string(value),
           "a divisor of " + std::string(whole_name) + " = " + std::to_string(whole));
    return std::max<std::int64_t>(value, 1);
  }

  template <class To, class From>
  To Enum(const char* field, From value, From max) {
    if (value > max)
      Fail(field, std::to_string(static_cast<int>(value)), "a value this version knows");
    return static_cast<To>(value);
  }

  float Epsilon(const char* field, float value) {
    if (!(value > 0.0f && value < 1.0f)) Fail(field, std::to_string(value), "0 < eps < 1");
    return value;
  }

  /// A finite slope, such as LeakyReLU's.
  float Slope(const char* field, float value) {
    if (!(value >= -10.0f && value <= 10.0f)) Fail(field, std::to_string(value), "-10 to 10");
    return value;
  }

  float Rate(const char* field, float value) {
    if (!(value >= 1.0f && value <= 1000.0f))
      Fail(field, std::to_string(value), "1 to 1000 frames a second");
    return value;
  }

  void Fail(const char* field, const std::string& found, const std::string& expected) {
    if (status_.ok())
      status_ = Status(Code::kBadWeights,
                       where_ + ": " + field + ": " + found + ", expected " + expected);
  }

  const Status& status() const { return status_; }

 private:
  std::string where_;
  Status status_;
};

}  // namespace gestus::models

#endif  // GESTUS_MODELS_CONFIG_H_
