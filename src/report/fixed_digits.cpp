#include "fixed_digits.hpp"

#include <cstdint>

#include "program/number_style.hpp"

namespace counterflex {

void append_fixed(std::string& text, double value, int decimals) {
  const std::optional<double> whole = whole_steps(value, decimals);
  if (!whole) {
    text += format_fixed(value, decimals);
    return;
  }
  char buffer[24];
  const char* const end = put_steps(static_cast<std::int64_t>(*whole), decimals, buffer);
  const std::ptrdiff_t point = decimals == 0 ? 1 : 0;  // there is always one
  text.append(buffer, static_cast<std::size_t>(end - buffer - point));
}

}  // namespace counterflex
