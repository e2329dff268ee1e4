#include "settings/number_text.hpp"

#include <array>
#include <charconv>

namespace counterflex::setting_file {

std::string number_text(double value) {
  std::array<char, 1100> buffer;  // the smallest double has 1074 digits behind the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value == 0 ? 0.0 : value,
                                 std::chars_format::fixed)
                       .ptr;
  return {buffer.data(), end};
}

}  // namespace counterflex::setting_file
