#pragma once
/// Values as bytes in the computer's own order, for files that one build of this program writes for itself.
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace counterflex {

/// Values that are a number, a character, a bool or an enumeration: their bytes are all that they are.
template <typename T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends the bytes of `value`; of a double all bits.
template <PlainValue T>
void put(T value, std::string& bytes) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Appends the length of `text`, and it.
inline void put(std::string_view text, std::string& bytes) {
  put(text.size(), bytes);
  bytes += text;
}

/// Takes from the beginning of bytes what `put` has appended. Where there are too few of them, what comes is
/// zero or empty, from then on: who has taken everything asks once whether it was there.
class BytesIn {
 public:
  explicit BytesIn(std::string_view bytes) : rest_(bytes) {}

  template <PlainValue T>
  T get() {
    T value{};
    const std::string_view raw = take(sizeof value);
    if constexpr (std::is_same_v<T, bool>)
      value = !raw.empty() && raw[0] != 0;
    else if (!raw.empty())
      std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }

  std::string_view get_text() { return take(get<std::size_t>()); }

  /// How many values follow, each of at least `size` bytes: never more than there is room for.
  std::size_t get_count(std::size_t size) {
    const auto count = get<std::size_t>();
    if (count <= rest_.size() / size) return count;
    fail();
    return 0;
  }

  /// No bytes where there are fewer than `count`.
  std::string_view take(std::size_t count) {
    if (count > rest_.size()) fail();
    if (failed_) return {};
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  /// Whether everything was there, and nothing is left.
  bool is_complete() const { return !failed_ && rest_.empty(); }
  bool has_failed() const { return failed_; }
  void fail() {
    failed_ = true;
    rest_ = {};
  }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace counterflex
