#include "report/json/fixed_digits.hpp"

#include <array>
#include <cstdint>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_characters = 24;  // of `put_steps`

// Writes the number at `to` and returns its end; nullptr where that is left to `format_fixed`.
char* put_fixed(double value, int decimals, char* to) {
  const std::optional<double> whole = whole_steps(value, decimals);
  if (!whole) return nullptr;
  char* const end = put_steps(static_cast<std::int64_t>(*whole), decimals, to);
  return decimals == 0 ? end - 1 : end;
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
  std::array<char, most_characters> buffer;
  if (const char* const end = put_fixed(value, decimals, buffer.data()))
    text.append(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  else
    text += format_fixed(value, decimals);
}

void append_cells(std::string& row, std::span<const double> values, int decimals) {
  std::array<char, 8 * (1 + most_characters)> buffer;
  char* to = buffer.data();
  const auto give_out = [&] {
    row.append(buffer.data(), static_cast<std::size_t>(to - buffer.data()));
    to = buffer.data();
  };
  for (const double value : values) {
    if (buffer.data() + buffer.size() - to < static_cast<std::ptrdiff_t>(1 + most_characters)) give_out();
    *to = ',';
    if (char* const end = put_fixed(value, decimals, to + 1)) {
      to = end;
    } else {
      give_out();
      row.append(",").append(format_fixed(value, decimals));
    }
  }
  give_out();
}

}  // namespace counterflex
