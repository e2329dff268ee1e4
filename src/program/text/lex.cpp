#include "program/text/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/siemens/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

std::string shown(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte >= 0x7f ? fmt::format("byte 0x{:02X}", byte) : fmt::format("'{}'", c);
}

constexpr std::array powers_of_ten{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

constexpr int whole_digits = 12;
constexpr double largest_number = 1e12;  // a double cannot hold thousandths of larger numbers

/// The value of a word with too many digits for exact products of integers. Refuses too large numbers.
double value_of_many_digits(const Scanner& s, const Word& word, int digits) {
  std::string dense;
  for (const char c : part(s.text, word.number))
    if (!is_blank(c)) dense += c;
  const std::optional<double> value = read_number(dense);
  if (word.decimals > most_decimals)
    s.refuse_at(word.span.begin, too_many_decimals({&word.letter, 1}, word.decimals));
  if (!value || std::abs(*value) > largest_number)
    s.refuse_at(word.span.begin, fmt::format("{}: a number of {} digits is too long", word.letter, digits));
  return *value;
}

/// Scans a number at `at`, blanks inside included. Moves `at` behind its last character. False if it has no
/// digit.
bool read_number_word(Scanner& s, Word& word) {
  const char* const text = s.text.data();
  const std::size_t begin = s.at, end = s.end;
  std::size_t last = begin;
  bool started = false, point = false;
  int digits = 0, decimals = 0;
  std::uint64_t mantissa = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const char c = text[i];
    if (is_digit(c)) {
      ++digits;
      decimals += point ? 1 : 0;
      mantissa = mantissa * 10 + static_cast<std::uint64_t>(c - '0');
    } else if (is_blank(c)) {
      continue;
    } else if (c == '.' && !point) {
      point = true;
    } else if (started || (c != '+' && c != '-')) {
      break;
    }
    started = true;
    last = i + 1;
  }
  word.number = {begin, last};
  word.decimals = decimals;
  word.point = point;
  s.at = last;
  if (digits == 0) return false;
  // Integers below 10^15 and these powers of ten are exact, so that the quotient is the nearest double.
  if (digits > 15 || digits - decimals > whole_digits) {
    word.value = value_of_many_digits(s, word, digits);
  } else {
    const double size = static_cast<double>(static_cast<std::int64_t>(mantissa)) /
                        powers_of_ten[static_cast<std::size_t>(decimals)];
    word.value = s.text[begin] == '-' ? -size : size;
  }
  return true;
}

[[noreturn]] void refuse_missing_number(Scanner& s, const Word& word) {
  s.at = word.span.begin + 1;
  s.skip_blanks();
  const char next = s.peek();
  if (next == '=') s.refuse_at(s.at, fmt::format("'{}=': assignments are not supported", word.letter));
  std::size_t stop = s.at;
  while (stop < s.end && is_letter(s.text[stop])) ++stop;
  const std::string_view instead = s.text.substr(s.at, stop - s.at);
  if (instead.size() > 1)
    s.refuse_at(word.span.begin, fmt::format("{} has no number: '{}' follows it", word.letter, instead));
  s.refuse_at(word.span.begin, fmt::format("{}{} has no number", word.letter, part(s.text, word.number)));
}

/// ",R" or ",C" of shop controls.
bool at_corner(const Scanner& s) {
  if (!s.dialect.macro_words || s.peek() != ',' || s.at + 1 >= s.end) return false;
  const char letter = upper(s.text[s.at + 1]);
  return letter == 'R' || letter == 'C';
}

/// Refuses an exponent or a second number directly behind the number of a word.
void check_after_number(const Scanner& s, const Word& word) {
  const char next = s.peek();
  if ((next == 'e' || next == 'E') && s.at + 1 < s.end) {
    const char after = s.text[s.at + 1];
    if (is_digit(after) || after == '+' || after == '-')
      s.refuse_at(s.at, fmt::format("{}{}{}{}: a number has no exponent here", word.letter,
                                    part(s.text, word.number), next, after));
  }
  if (next == ',' && !at_corner(s)) s.refuse_at(s.at, "',': write decimals with a point");
}

/// An expression as value.
void read_expression_word(Scanner& s, Word& word) {
  word.literal = false;
  const std::size_t begin = s.at;
  skip_expression(s);
  word.number = {begin, s.at};
}

}  // namespace

void lex_word(Scanner& s) {
  Word& word = s.block.words.emplace_back();
  word.letter = upper(s.peek());
  word.span = {s.at, s.at + 1};
  ++s.at;
  s.skip_blanks();
  const std::size_t begin = s.at;
  if (!read_number_word(s, word)) {
    s.at = begin;
    if (part(s.text, word.number).find('.') != std::string_view::npos || !at_expression(s))
      refuse_missing_number(s, word);
    read_expression_word(s, word);
  }
  word.span.end = s.at;
  check_after_number(s, word);
}

namespace {

/// Position of the ')' that closes the comment at the scanner, with brackets in pairs, or the end. A control
/// without nested comments would find a ')' outside comments, and stop.
std::size_t end_of_nested_comment(const Scanner& s) {
  int depth = 0;
  for (std::size_t at = s.at; at < s.end; ++at) {
    if (s.text[at] == comment_open) ++depth;
    if (s.text[at] == comment_close && --depth == 0) return at;
  }
  return s.end;
}

void lex_comment(Scanner& s) {
  const std::size_t open = s.at;
  if (const std::size_t end = end_of_nested_comment(s); s.dialect.parentheses_nest && end < s.end)
    s.at = end - 1;
  for (++s.at; s.at < s.end && s.text[s.at] != comment_close; ++s.at)
    if (s.text[s.at] == comment_open && !s.dialect.parentheses_nest)
      s.refuse_at(s.at, "comments must not be nested");
  if (s.at == s.end && !s.dialect.comments_may_stay_open)
    s.refuse_at(open, "the comment is not closed on its line");
  s.block.comments.push_back({open + 1, s.at});
  if (s.at < s.end) ++s.at;
}

void lex_semicolon(Scanner& s) {
  const std::size_t begin = s.at + 1;
  const std::string_view rest = s.text.substr(begin, s.end - begin);
  const std::size_t text_begin = rest.find_first_not_of(" \t;");
  const bool comment = text_begin != std::string_view::npos && rest[text_begin] == comment_open &&
                       rest.find(comment_close, text_begin) + 1 == rest.size();
  if (!s.dialect.semicolon_comments && text_begin != std::string_view::npos && !comment)
    s.refuse_at(s.at, fmt::format("';' ends a block in dialect {}; write comments in round brackets",
                                  s.dialect.name));
  s.block.comments.push_back({begin, s.end});
  s.at = s.end;
}

void lex_block_delete(Scanner& s) {
  const std::size_t begin = s.at;
  const bool after_number =
      s.block.words.size() == 1 && s.block.words[0].letter == 'N' && s.dialect.block_delete_numbers;
  if (!empty(s.block.block_delete) || !(s.block.words.empty() || after_number))
    s.refuse_at(begin, "'/' is only allowed at the beginning of a block");
  ++s.at;
  if (s.dialect.block_delete_numbers && is_digit(s.peek())) ++s.at;
  s.block.block_delete = {begin, s.at};
}

void refuse_conflict_marker(const Scanner& s) {
  for (const std::string_view marker : {"<<<<<<<", "=======", ">>>>>>>", "|||||||"})
    if (s.text.substr(s.at, s.end - s.at).starts_with(marker))
      s.refuse_at(s.at, fmt::format("'{}' is a conflict marker of a version control system", marker));
}

}  // namespace

void refuse_character(const Scanner& s) {
  const char c = s.peek();
  refuse_conflict_marker(s);
  if (c == '*')
    s.refuse_at(s.at,
                "'*' begins a checksum, which would be wrong in a corrected block: post the program without "
                "checksums");
  if (c == '\r')
    s.refuse_at(s.at, "byte 0x0D is not allowed here: lines end with LF or CR LF, not with CR alone");
  if (c == '{' || c == '}')
    s.refuse_at(s.at,
                fmt::format("{} is not allowed here: text in braces is for a preprocessor; run it first, and "
                            "correct its output",
                            shown(c)));
  s.refuse_at(s.at,
              fmt::format("{} is not allowed here: a block has letters with one number each, and comments",
                          shown(c)));
}

namespace {

/// The size of a corner is not a position. Corrections do not change it.
void lex_corner(Scanner& s) {
  ++s.at;
  lex_word(s);
  const Word& word = s.block.words.back();
  s.block.corner =
      CornerSize{word.literal ? word.value : NAN, word.letter == 'R' ? CornerKind::round : CornerKind::side};
  s.block.words.pop_back();
}

/// ":1001" is a program number; before other words it is a block number, as N.
void lex_colon(Scanner& s) {
  const bool first = s.block.words.empty();
  if (!first || s.at + 1 >= s.end || !is_digit(s.text[s.at + 1])) refuse_character(s);
  lex_word(s);
  s.skip_blanks();
  const bool alone = s.at == s.end || s.peek() == comment_open || s.peek() == ';';
  s.block.words.back().letter = alone ? 'O' : 'N';
}

/// "<PART-1>" or "O<PART-1>" of newer shop controls.
bool is_part_name_at(const Scanner& s) {
  if (!s.dialect.percent_names || !s.block.words.empty()) return false;
  const std::size_t open = upper(s.peek()) == 'O' ? s.at + 1 : s.at;
  return open < s.end && s.text[open] == '<' &&
         s.text.substr(s.at, s.end - s.at).find('>') != std::string_view::npos;
}

/// The name of a program is not a word. It replaces the program number.
void lex_part_name(Scanner& s) {
  s.at = s.text.find('>', s.at) + 1;
  s.block.part_name = true;
}

void lex_percent(Scanner& s) {
  ++s.at;
  s.skip_blanks();
  s.block.percent = true;
  const std::string_view rest = s.text.substr(s.at, s.end - s.at);
  const bool ends = rest.find_first_not_of("; \t") == std::string_view::npos;
  // Programs of Fagor controls begin like this; their cycles differ.
  s.block.part_name = !ends && s.dialect.percent_names && rest.find(',') == std::string_view::npos;
  if (!ends && !s.block.part_name) s.refuse_at(s.at, "a '%' must be alone in its line");
}

}  // namespace

bool begins_with_program_number(const Block& block) {
  const std::vector<Word>& words = block.words;
  const std::size_t first = !words.empty() && words[0].letter == 'N' ? 1 : 0;
  const auto is_axis = [](const Word& word) { return word.letter >= 'X' && word.letter <= 'Z'; };
  return words.size() > first && words[first].letter == 'O' &&
         std::none_of(words.begin(), words.end(), is_axis);
}

long count_of(const Word& word) {
  constexpr double beyond = 1e15;
  return static_cast<long>(std::clamp(word.value, -beyond, beyond));
}

bool next_line(std::string_view text, Block& block) {
  const std::size_t begin = block.line_end.end;
  if (begin >= text.size()) return false;
  const std::size_t newline = text.find('\n', begin);
  const std::size_t next = newline == std::string_view::npos ? text.size() : newline + 1;
  std::size_t end = newline == std::string_view::npos ? next : newline;
  while (end > begin && text[end - 1] == '\r') --end;
  block.span = {begin, end};
  block.line_end = {end, next};
  block.line = ++block.text_line;
  return true;
}

void lex(std::string_view text, const std::string& file, const Dialect& dialect, Block& block) {
  block.words.clear();
  block.assignments.clear();
  block.speed_words.clear();
  block.comments.clear();
  block.block_delete = {};
  block.percent = block.part_name = false;
  block.corner.reset();
  block.angle.reset();
  block.assigns = block.assigns_by_name = false;
  block.flow_keyword = block.flow_name = {};
  block.statement = Statement::none;
  block.statement_is_bare = block.has_own_mode = false;
  if (is_guard_line(part(text, block.span))) return;  // checks that counterflex wrote move nothing
  // The UTF-8 byte order mark is before the first block.
  if (block.text_line == 1 && block.span.begin == 0) block.span.begin += byte_order_mark(text);
  Scanner s{block.span.end, text, file, dialect, block, block.span.begin};
  while (s.at < s.end && is_ignored(text[s.at])) ++s.at;
  while (s.at < s.end && is_ignored(text[s.end - 1])) --s.end;
  if (dialect.sinumerik_words) return lex_siemens(s);
  s.skip_blanks();
  if (s.peek() == '%') return lex_percent(s);
  for (; s.at < s.end; s.skip_blanks()) {
    const char c = s.peek();
    if (is_part_name_at(s)) {
      lex_part_name(s);
    } else if (is_letter(c)) {
      const char next = s.at + 1 < s.end ? s.text[s.at + 1] : '\0';
      const bool may_flow = is_letter(next) || (s.dialect.o_words && (c == 'o' || c == 'O'));
      if (!may_flow || !lex_flow(s)) lex_word(s);
    } else if (c == '#') {
      skip_assignment(s);
    } else if (c == ',' && at_corner(s)) {
      lex_corner(s);
    } else if (c == ':' && dialect.percent_names) {
      lex_colon(s);
    } else if (c == comment_open) {
      lex_comment(s);
    } else if (c == ';') {
      lex_semicolon(s);
    } else if (c == '/') {
      lex_block_delete(s);
    } else {
      refuse_character(s);
    }
  }
}

void refuse(const std::string& file, const Block& block, std::size_t at, const std::string& message,
            ErrorKind kind) {
  const std::string from =
      block.called_from > 0 ? fmt::format(" (called from line {})", block.called_from) : std::string();
  throw InputError(kind, {file, block.line, static_cast<int>(at - block.span.begin) + 1}, message + from);
}

}  // namespace counterflex
