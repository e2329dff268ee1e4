#include "program/klartext/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr double largest_klartext_number = 99999.9999;

// Longer keys before their own prefixes.
constexpr std::array<std::string_view, 38> klartext_keys{
    "LEN", "LA", "CCA", "IPA", "IPR", "PA", "PR", "FMAX", "FAUTO", "DR", "RL", "RR", "IX",
    "IY",  "IZ", "IA",  "IB",  "IC",  "IU", "IV", "IW",   "FU",    "FZ", "FT", "X",  "Y",
    "Z",   "A",  "B",   "C",   "U",   "V",  "W",  "R",    "F",     "MB", "M",  "S"};

char klartext_upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
bool klartext_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}
bool klartext_digit(char c) {
  return c >= '0' && c <= '9';
}
bool klartext_letter(char c) {
  return klartext_upper(c) >= 'A' && klartext_upper(c) <= 'Z';
}

std::size_t skip_blanks(std::string_view text, std::size_t at, std::size_t end) {
  while (at < end && klartext_blank(text[at])) ++at;
  return at;
}

/// "*", "( setup sheet", "-----": the whole line is a comment.
bool is_comment_line(std::string_view line) {
  return line.starts_with('*') || line.starts_with('(') ||
         (line.starts_with("--") && line.find_first_not_of("- \t\r") == std::string_view::npos);
}

/// Position of the comment in [begin, end), or `end`.
std::size_t comment_begin(std::string_view text, std::size_t begin, std::size_t end, bool first) {
  const std::size_t start = skip_blanks(text, begin, end);
  if (first && is_comment_line(part(text, {start, end}))) return start;
  bool quoted = false;
  for (std::size_t at = begin; at < end; ++at) {
    if (text[at] == '"') quoted = !quoted;
    if (text[at] == ';' && !quoted) return at;
  }
  return end;
}

/// '/' and the block's number ("5", "N5"), in either order; returns what follows.
std::size_t lex_start(std::string_view text, KlartextBlock& block, std::size_t at, std::size_t end) {
  for (int i = 0; i < 3; ++i) {
    at = skip_blanks(text, at, end);
    if (at + 1 < end && klartext_upper(text[at]) == 'N' && klartext_digit(text[at + 1])) ++at;
    if (at < end && text[at] == '/' && empty(block.block_delete)) {
      block.block_delete = {at, at + 1};
      ++at;
    } else if (at < end && klartext_digit(text[at]) && empty(block.number)) {
      const std::size_t begin = at;
      while (at < end && klartext_digit(text[at])) ++at;
      block.number = {begin, at};
    }
  }
  return skip_blanks(text, at, end);
}

/// Whether the line continues in the next line; moves `end` before its '~'.
bool cut_continuation(std::string_view text, std::size_t begin, std::size_t& end) {
  std::size_t last = end;
  while (last > begin && klartext_blank(text[last - 1])) --last;
  if (last == begin || text[last - 1] != '~') return false;
  end = last - 1;
  return true;
}

/// A word being read: `at` is behind the consumed part of [at, end).
struct WordScanner {
  std::string_view text;
  const std::string& file;
  const KlartextBlock& block;
  std::size_t at;
  std::size_t end;

  char peek() const { return at < end ? text[at] : '\0'; }
  void skip() { at = skip_blanks(text, at, end); }
};

std::string_view key_at(const WordScanner& s) {
  for (const std::string_view key : klartext_keys) {
    if (s.end - s.at < key.size()) continue;
    std::size_t i = 0;
    while (i < key.size() && klartext_upper(s.text[s.at + i]) == key[i]) ++i;
    if (i == key.size()) return key;
  }
  return {};
}

bool is_coordinate(const KlartextWord& word) {
  return word.key.size() == 1 && std::string_view("XYZABCUVW").find(word.key[0]) != std::string_view::npos;
}

/// Q5, QL1, QR2: a parameter instead of a number.
bool take_parameter(WordScanner& s) {
  if (klartext_upper(s.peek()) != 'Q') return false;
  while (klartext_letter(s.peek())) ++s.at;
  while (klartext_digit(s.peek())) ++s.at;
  return true;
}

void check_klartext_number(const WordScanner& s, const KlartextWord& word) {
  const char next = klartext_upper(s.peek());
  const char after = s.at + 1 < s.end ? s.text[s.at + 1] : '\0';
  if (next == 'E' && (klartext_digit(after) || after == '+' || after == '-'))
    refuse_klartext(
        s.text, s.file, s.block, s.at,
        fmt::format("{}: a number has no exponent here", part(s.text, {word.span.begin, s.at + 2})));
  if (is_coordinate(word) && std::abs(word.value) > largest_klartext_number)
    refuse_klartext(s.text, s.file, s.block, word.span.begin,
                    fmt::format("{}: coordinates are at most {:.4f}", part(s.text, {word.span.begin, s.at}),
                                largest_klartext_number));
}

/// Digits with a point or a comma.
bool take_digits(WordScanner& s, KlartextWord& word, bool negative) {
  std::string dense = negative ? "-" : "";
  bool point = false;
  int digits = 0;
  for (; s.at < s.end; ++s.at) {
    const char c = s.peek();
    const bool mark = (c == '.' || c == ',') && !point;
    if (!mark && !klartext_digit(c)) break;
    point = point || mark;
    dense += mark ? '.' : c;
    if (!mark) ++digits, word.decimals += point ? 1 : 0;
  }
  if (digits == 0) return false;
  if (word.decimals > most_decimals)
    refuse_klartext(s.text, s.file, s.block, word.span.begin, too_many_decimals(word.key, word.decimals));
  const auto value = read_number(dense);
  if (!value || std::abs(*value) > 1e12)
    refuse_klartext(s.text, s.file, s.block, word.span.begin,
                    fmt::format("{}: a number of {} digits is too long", word.key, digits));
  word.value = *value;
  word.literal = true;
  return true;
}

void take_value(WordScanner& s, KlartextWord& word) {
  const std::size_t behind_key = s.at;
  s.skip();
  const std::size_t begin = s.at;
  const char sign = s.peek();
  if (sign == '+' || sign == '-') {
    ++s.at;
    if (word.key != "DR") s.skip();
  }
  if (!take_parameter(s) && take_digits(s, word, sign == '-')) check_klartext_number(s, word);
  const bool sign_alone = word.key == "DR" && s.at > begin;
  if (is_coordinate(word) && !word.literal && (s.at == begin || !klartext_digit(s.text[s.at - 1]))) {
    std::size_t stop = s.at;
    while (stop < s.end && !klartext_blank(s.text[stop])) ++stop;
    refuse_klartext(s.text, s.file, s.block, word.span.begin,
                    stop == s.at ? fmt::format("{} has no number", word.key)
                                 : fmt::format("{} has no number: '{}' follows it", word.key,
                                               part(s.text, {s.at, stop})));
  }
  if (s.at == begin) s.at = behind_key;
  if (word.literal || sign_alone) word.number = {begin, s.at};
}

bool take_name(WordScanner& s, std::string_view name) {
  const std::size_t at = skip_blanks(s.text, s.at, s.end);
  if (s.end - at < name.size() || squeezed(s.text.substr(at, name.size())) != name) return false;
  s.at = at + name.size();
  return true;
}

/// LA is the number of blocks of M120.
bool follows_look_ahead(const std::vector<KlartextWord>& words) {
  return !words.empty() && words.back().key == "M" && words.back().value == 120;
}

/// "C" of M94 C and M138 C: an axis without a coordinate.
bool is_axis_of_code(const WordScanner& s, std::string_view key, const std::vector<KlartextWord>& words) {
  const bool axis = key.size() == 1 && std::string_view("ABCUVWXYZ").find(key[0]) != std::string_view::npos;
  const bool code = std::any_of(words.begin(), words.end(), [](const KlartextWord& word) {
    return word.key == "M" && (word.value == 94 || word.value == 138);
  });
  const std::size_t behind = skip_blanks(s.text, s.at + key.size(), s.end);
  return axis && code &&
         (behind >= s.end || (klartext_letter(s.text[behind]) && klartext_upper(s.text[behind]) != 'Q'));
}

/// Whether `word` is a limit of M118: how far the handwheel may move that axis. Limits follow M118 directly.
bool limits_handwheel(const KlartextWord& word, const std::vector<KlartextWord>& words) {
  return is_coordinate(word) && !word.incremental && words.back().key == "M" && words.back().value == 118;
}

bool has_handwheel(const std::vector<KlartextWord>& words) {
  return std::any_of(words.begin(), words.end(),
                     [](const KlartextWord& word) { return word.key == "M" && word.value == 118; });
}

/// A coordinate of an axis that the block has already.
void refuse_repeated_axis(const WordScanner& s, const KlartextWord& word,
                          const std::vector<KlartextWord>& words) {
  if (is_coordinate(word) && find_word(words, word.key) != nullptr)
    refuse_klartext(s.text, s.file, s.block, word.span.begin,
                    fmt::format("{} occurs twice in the block", word.key));
}

bool take_word(WordScanner& s, std::vector<KlartextWord>& words) {
  if (s.peek() == '(') {  // a comment
    s.at = std::min(s.text.find(')', s.at), s.end - 1) + 1;
    return true;
  }
  const std::string_view key = key_at(s);
  if (key.empty()) return false;
  if (key == "LA" && !follows_look_ahead(words)) return false;
  if (is_axis_of_code(s, key, words)) {
    ++s.at;
    return true;
  }
  KlartextWord word;
  word.incremental = key.size() == 2 && key[0] == 'I';
  word.key = key.substr(word.incremental ? 1 : 0);
  word.span.begin = s.at;
  s.at += key.size();
  if (key == "F" && take_name(s, "MAX")) word.key = "FMAX";  // "F MAX" of older controls
  if (key == "F" && take_name(s, "AUTO")) word.key = "FAUTO";
  const bool is_name = word.key == "FMAX" || word.key == "FAUTO" || key == "RL" || key == "RR";
  if (!is_name && !(key == "MB" && take_name(s, "MAX"))) take_value(s, word);
  word.span.end = s.at;
  const bool polar = word.key.ends_with("PA") || word.key.ends_with("PR");
  if (polar && s.block.head != "CP" && s.block.head != "LP") return false;
  if (is_coordinate(word) && has_handwheel(words)) return limits_handwheel(word, words);
  refuse_repeated_axis(s, word, words);
  words.push_back(std::move(word));
  return true;
}

/// The first block with a statement. If there is no such block, the result has no parts.
KlartextBlock first_statement(std::string_view text) {
  KlartextBlock block;
  while (next_klartext_block(text, block))
    if (!block.parts.empty()) break;
  return block;
}

}  // namespace

std::string squeezed(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (!klartext_blank(c) && c != '\n') result += klartext_upper(c);
  return result;
}

bool is_klartext(std::string_view text) {
  const KlartextBlock first = first_statement(text);
  return first.head == "BEGIN" && squeezed(after_head(text, first)).starts_with("PGM");
}

bool begins_like_klartext(std::string_view text) {
  constexpr std::array<std::string_view, 12> heads{"BEGIN", "BLK",  "TOOL", "CYCL", "L",     "CC",
                                                   "LBL",   "CALL", "FN",   "STOP", "PLANE", "Q"};
  return std::find(heads.begin(), heads.end(), first_statement(text).head) != heads.end();
}

bool next_klartext_block(std::string_view text, KlartextBlock& block) {
  std::size_t begin = block.line_end.end;
  if (begin == 0) begin = byte_order_mark(text);
  if (begin >= text.size()) return false;
  block.line = ++block.last_line;
  block.span.begin = begin;
  block.block_delete = block.number = {};
  block.head.clear();
  block.parts.clear();
  block.comments.clear();
  for (bool first = true;; first = false, ++block.last_line) {
    const std::size_t newline = std::min(text.find('\n', begin), text.size());
    std::size_t end = newline;
    while (end > begin && text[end - 1] == '\r') --end;
    block.span.end = end;
    block.line_end = {end, std::min(newline + 1, text.size())};
    const bool continues = cut_continuation(text, begin, end) && block.line_end.end < text.size();
    const std::size_t start = first ? lex_start(text, block, begin, end) : skip_blanks(text, begin, end);
    const std::size_t comment = comment_begin(text, start, end, first);
    if (comment > start) block.parts.push_back({start, comment});
    if (comment < end) block.comments.push_back({comment + 1, end});
    if (!continues) break;
    begin = block.line_end.end;
  }
  if (!block.parts.empty() && is_guard_line(part(text, {block.parts[0].begin, block.span.end})))
    block.parts.clear(), block.comments.clear();  // checks that counterflex wrote move nothing
  if (!block.parts.empty())
    for (std::size_t at = block.parts[0].begin; at < block.parts[0].end && klartext_letter(text[at]); ++at)
      block.head += klartext_upper(text[at]);
  return true;
}

bool continues_behind(std::string_view text, std::size_t newline) {
  std::size_t end = newline;
  while (end > 0 && text[end - 1] == '\r') --end;
  return cut_continuation(text, 0, end);
}

std::string_view after_head(std::string_view text, const KlartextBlock& block) {
  if (block.parts.empty()) return {};
  return part(text, {block.parts[0].begin + block.head.size(), block.parts[0].end});
}

std::string_view approach_kind(std::string_view text, const KlartextBlock& block) {
  constexpr std::array<std::string_view, 4> kinds{"LCT", "LT", "LN", "CT"};
  const std::string rest = squeezed(after_head(text, block));
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](auto k) { return rest.starts_with(k); });
  return kind == kinds.end() ? std::string_view() : *kind;
}

bool lex_klartext_words(std::string_view text, const std::string& file, const KlartextBlock& block,
                        std::vector<KlartextWord>& words) {
  words.clear();
  const bool approaches = block.head == "APPR" || block.head == "DEP";
  const std::string_view kind = approaches ? approach_kind(text, block) : std::string_view();
  if (approaches && kind.empty()) return false;
  for (const Span& line : block.parts) {
    WordScanner s{text, file, block, line.begin, line.end};
    if (line.begin == block.parts[0].begin) {
      s.at += block.head.size();
      s.skip();
      s.at += kind.size();
    }
    for (s.skip(); s.at < s.end; s.skip())
      if (!take_word(s, words)) return false;
  }
  return true;
}

std::size_t find_coordinate(std::string_view text, const KlartextBlock& block) {
  for (const Span& line : block.parts) {
    bool quoted = false;
    for (std::size_t at = line.begin + 1; at + 1 < line.end; ++at) {
      if (text[at] == '"') quoted = !quoted;
      if (text[at] == '(' && !quoted) break;  // a comment
      const bool axis = std::string_view("XYZ").find(klartext_upper(text[at])) != std::string_view::npos;
      const char behind = text[at + 1];
      if (!quoted && axis && klartext_blank(text[at - 1]) &&
          (klartext_digit(behind) || behind == '+' || behind == '-'))
        return at;
    }
  }
  return std::string_view::npos;
}

const KlartextWord* find_word(const std::vector<KlartextWord>& words, std::string_view key) {
  const auto found = std::find_if(words.begin(), words.end(), [&](auto& word) { return word.key == key; });
  return found == words.end() ? nullptr : &*found;
}

void refuse_klartext(std::string_view text, const std::string& file, const KlartextBlock& block,
                     std::size_t at, const std::string& message) {
  Block place;
  place.line = block.file_line > 0 ? block.file_line : block.line;
  place.span = block.span;
  for (std::size_t i = block.span.begin; i < at; ++i)
    if (text[i] == '\n') ++place.line, place.span.begin = i + 1;
  refuse(file, place, at, message);
}

}  // namespace counterflex
