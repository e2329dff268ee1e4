#pragma once
/// An optional value on the heap, for members that few of many objects have.
#include <memory>
#include <optional>
#include <utility>

namespace counterflex {

/// An optional `T`. The value is on the heap: an empty one has the size of a pointer. Copies are deep.
/// Setting a value allocates.
template <typename T>
class BoxedOptional {
 public:
  BoxedOptional() = default;
  BoxedOptional(std::nullopt_t) {}
  BoxedOptional(const T& value) : value_(std::make_unique<T>(value)) {}
  BoxedOptional(const std::optional<T>& value) : value_(value ? std::make_unique<T>(*value) : nullptr) {}
  BoxedOptional(const BoxedOptional& other)
      : value_(other.value_ ? std::make_unique<T>(*other.value_) : nullptr) {}
  BoxedOptional(BoxedOptional&& other) noexcept = default;
  BoxedOptional& operator=(BoxedOptional other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }
  ~BoxedOptional() = default;

  bool has_value() const { return value_ != nullptr; }
  explicit operator bool() const { return has_value(); }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return value_.get(); }
  const T* operator->() const { return value_.get(); }
  T value_or(const T& otherwise) const { return value_ ? *value_ : otherwise; }
  T& emplace() { return *(value_ = std::make_unique<T>()); }
  void reset() { value_.reset(); }

  friend bool operator==(const BoxedOptional& a, const T& b) { return a.value_ && *a.value_ == b; }

 private:
  std::unique_ptr<T> value_;
};

}  // namespace counterflex
