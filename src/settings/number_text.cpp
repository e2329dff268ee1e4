#include "settings/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace counterflex::setting_file {

std::string number_text(double value) {
  // In TOML a number without a point or an exponent is an integer of 64 bits. toml++ reads at most 127
  // characters of a number.
  const double size = std::abs(value);
  const bool fixed = size == 0 || (size >= 1e-6 && size < 1e15);
  std::array<char, 40> buffer;  // 15 digits before the point, or 22 after it
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value == 0 ? 0.0 : value,
                                 fixed ? std::chars_format::fixed : std::chars_format::scientific)
                       .ptr;
  return {buffer.data(), end};
}

}  // namespace counterflex::setting_file
