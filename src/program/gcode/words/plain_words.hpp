#pragma once
/// Reads the words of a line whose letters have the same meaning in all dialects and whose numbers are plain.
#include <array>
#include <cstdint>

#include "program/text/scanner.hpp"

namespace counterflex {

/// X, Y and Z are 0, 1 and 2, as axes are.
enum class PlainWord : std::uint8_t { x, y, z, feed, code, number, none };

struct PlainNumber {
  const char* begin;
  const char* end;
  double value;
  int decimals;
};

/// Numbers of words that are not in `present` are undefined.
struct PlainWords {
  std::array<PlainNumber, 4> numbers;  ///< X, Y, Z, F
  std::int64_t code;                   ///< 0 or 1 of G
  std::int64_t block_number;           ///< N
  unsigned present = 0;                ///< a bit for each PlainWord

  bool has(PlainWord word) const { return (present >> static_cast<unsigned>(word) & 1) != 0; }
  bool has_axis() const { return (present & 7) != 0; }
};

inline PlainWord plain_word_of(char letter) {
  static constexpr auto table = [] {
    std::array<PlainWord, 256> words{};
    words.fill(PlainWord::none);
    constexpr std::string_view letters = "XYZFGN";
    for (std::size_t i = 0; i < letters.size(); ++i) {
      words[static_cast<std::size_t>(letters[i])] = static_cast<PlainWord>(i);
      words[static_cast<std::size_t>(letters[i] - 'A' + 'a')] = static_cast<PlainWord>(i);
    }
    return words;
  }();
  return table[static_cast<unsigned char>(letter)];
}

// Text ends with a byte 0, as strings do. No word contains it, so its end needs no test.

/// Position behind the digits at `at`. Appends the digits to `value`.
inline const char* scan_digits(const char* at, std::uint64_t& value) {
  const auto digit_at = [](const char* c) {
    return static_cast<unsigned>(static_cast<unsigned char>(*c)) - '0';
  };
  for (unsigned digit = digit_at(at); digit <= 9; digit = digit_at(++at)) value = value * 10 + digit;
  return at;
}

/// Position behind the number at `at`; nullptr for a number that `lex` does not read in the same way.
/// Integers below 10^15 and these powers of ten are exact, so that the quotient is the nearest double.
inline const char* scan_number(const char* at, PlainNumber& number) {
  static constexpr std::array powers{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  constexpr std::ptrdiff_t most_whole = 12, most = 15;
  number.begin = at;
  const bool negative = *at == '-';
  if (negative || *at == '+') ++at;
  std::uint64_t mantissa = 0;
  const char* const point = scan_digits(at, mantissa);
  const std::ptrdiff_t whole = point - at;
  number.end = point;
  number.decimals = 0;
  if (*point == '.') {
    number.end = scan_digits(point + 1, mantissa);
    number.decimals = static_cast<int>(number.end - point - 1);
  }
  const std::ptrdiff_t digits = whole + number.decimals;
  if (digits == 0 || digits > most || whole > most_whole) return nullptr;
  const double size = static_cast<double>(static_cast<std::int64_t>(mantissa)) /
                      powers[static_cast<std::size_t>(number.decimals)];
  number.value = negative ? -size : size;
  return number.end;
}

/// Position behind the integer at `at`; nullptr for no digits or too many.
inline const char* scan_whole(const char* at, std::int64_t& number) {
  std::uint64_t value = 0;
  const char* const end = scan_digits(at, value);
  number = static_cast<std::int64_t>(value);
  return end == at || end - at > 12 ? nullptr : end;
}

/// Position behind the word at `at`; nullptr if it is not plain.
inline const char* scan_word(const char* at, PlainWord word, PlainWords& words) {
  if (words.has(word)) return nullptr;
  if (word == PlainWord::number) return words.present == 0 ? scan_whole(at + 1, words.block_number) : nullptr;
  if (word != PlainWord::code) return scan_number(at + 1, words.numbers[static_cast<std::size_t>(word)]);
  const char* const end = scan_whole(at + 1, words.code);
  return words.code <= 1 ? end : nullptr;
}

/// Reads the words of the line at `at`, up to the first other character, whose position is returned; nullptr
/// if a word of these letters is not plain.
inline const char* scan_words(const char* at, PlainWords& words) {
  words.present = 0;
  for (;;) {
    while (is_blank(*at)) ++at;
    const PlainWord word = plain_word_of(*at);
    if (word == PlainWord::none) return at;
    at = scan_word(at, word, words);
    if (at == nullptr) return nullptr;
    words.present |= 1u << static_cast<unsigned>(word);
  }
}

}  // namespace counterflex
