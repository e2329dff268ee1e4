#include "program/siemens/signs.hpp"

#include <algorithm>
#include <string>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t searched = 1 << 16;  // bytes

/// The part of a line before its comment in upper case, without text in round brackets or quotes.
std::string statements_of(std::string_view line) {
  std::string kept;
  int depth = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ';') break;
    if (c == '(') kept += c, ++depth;
    if (c == ')' && depth > 0) --depth;
    if (depth == 0) kept += upper(c);
  }
  return kept;
}

/// Quick test: two letters in a row, or a G5 that may be G500. Most lines of G-code have neither.
bool may_have_names(std::string_view line) {
  char before = ' ';
  for (const char c : line) {
    if (is_letter(before) && (is_letter(c) || (c == '5' && upper(before) == 'G'))) return true;
    before = c;
  }
  return false;
}

/// REPEAT or REPEATB with labels behind it. "REPEAT_LAB:" and "END_REPEAT:" are labels. "N80REPEAT" needs no
/// blank.
bool repeats_part(const std::string& words) {
  constexpr std::string_view repeat = "REPEAT";
  for (std::size_t at = 0; (at = words.find(repeat, at)) != std::string::npos;) {
    const char before = at > 0 ? words[at - 1] : ' ';
    at += repeat.size();
    if (is_identifier_character(before) && !is_digit(before)) continue;
    const std::size_t behind = at + (at < words.size() && words[at] == 'B' ? 1 : 0);
    if (behind < words.size() && is_identifier_character(words[behind])) continue;
    if (words.find_first_not_of(" \t\r", behind) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

bool is_siemens(std::string_view text) {
  text = text.substr(0, searched);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with("%_N_") || line.starts_with(";%_N_") || line.starts_with(";$PATH=")) return true;
    if (may_have_names(line) && line.find_first_of("#<") == std::string_view::npos) {
      const std::string words = statements_of(line);
      for (const std::string_view only :
           {"CR=", "MSG(", "SUPA", "STOPRE", "MCALL", "CYCLE8", "GOTOF", "GOTOB", "TRAORI", "WORKPIECE(",
            "=AC(", "=IC(", "G500 ", "COMPCAD", "T=\"", "TRANS "})
        if (words.find(only) != std::string::npos) return true;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

bool siemens_jumps(std::string_view text) {
  Block block;
  while (next_line(text, block)) {
    const std::string_view line = part(text, block.span);
    if (!may_have_names(line)) continue;
    const std::string words = statements_of(line);
    if (words.find("GOTO") != std::string::npos) return true;
    if (repeats_part(words)) return true;
  }
  return false;
}

}  // namespace counterflex
