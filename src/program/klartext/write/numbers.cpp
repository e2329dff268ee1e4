#include "program/klartext/write/numbers.hpp"

#include "program/klartext/lex.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

unsigned long number_of(std::string_view digits) {
  unsigned long number = 0;
  for (const char c : digits.substr(0, 9)) number = number * 10 + static_cast<unsigned long>(c - '0');
  return number;
}

}  // namespace

std::string renumbered_klartext(const std::string& text, WrittenNumbers& numbers) {
  std::string result;
  result.reserve(text.size() + text.size() / 64);
  std::size_t copied = 0;
  KlartextBlock block;
  while (!numbers.ended && next_klartext_block(text, block)) {
    numbers.ended = block.head == "END";
    if (empty(block.number)) continue;
    const unsigned long written = number_of(part(text, block.number));
    const unsigned long number = numbers.renumbers && numbers.last ? *numbers.last + 1 : written;
    numbers.last = number;
    if (number == written) continue;
    result.append(text, copied, block.number.begin - copied).append(std::to_string(number));
    copied = block.number.end;
  }
  return result.append(text, copied);
}

}  // namespace counterflex
