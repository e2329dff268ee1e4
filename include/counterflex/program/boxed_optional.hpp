#pragma once
/// An optional value on the heap, for members that few of many objects have.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

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

// Lists with line numbers that are limited in length: a report shows the first rows.

/// Largest number of rows in the lists of uncorrected blocks and of warnings.
inline constexpr std::size_t listed_at_most = 100;

/// A list of limited length. `count` is the number of rows without the limit.
template <typename T>
struct Capped {
  std::vector<T> rows;
  std::size_t count = 0;
};

/// Inserts `row` in the order of lines. Rows without a line (0) come first, rows of one line keep their
/// order. If there are more than `listed_at_most` rows, the last one is dropped.
template <typename T>
void list(Capped<T>& capped, T row) {
  ++capped.count;
  auto& rows = capped.rows;
  if (rows.size() == listed_at_most && rows.back().line <= row.line) return;
  const auto place =
      std::upper_bound(rows.begin(), rows.end(), row, [](const T& a, const T& b) { return a.line < b.line; });
  rows.insert(place, std::move(row));
  if (rows.size() > listed_at_most) rows.pop_back();
}

/// Appends the rows of `later` and adds its count.
template <typename T>
void list(Capped<T>& capped, const Capped<T>& later) {
  const std::size_t count = capped.count + later.count;
  for (const T& row : later.rows) list(capped, row);
  capped.count = count;
}

}  // namespace counterflex
