#include "program/detect/robot_language.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>

#include "program/dialect.hpp"

namespace counterflex {
namespace {

bool is_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Whether `line` is `word`, a blank and more text. `any_case`: upper and lower case.
bool begins_with(std::string_view line, std::string_view word, bool any_case) {
  if (line.size() < word.size()) return false;
  const auto same = [&](char a, char b) {
    return any_case ? std::toupper(static_cast<unsigned char>(a)) == b : a == b;
  };
  return std::equal(word.begin(), word.end(), line.begin(), [&](char w, char l) { return same(l, w); }) &&
         (line.size() == word.size() || !is_name(line[word.size()]));
}

/// `NAME ( ... )` and `end`: the definition of a program. In Siemens programs `DEF REAL NAME` defines a
/// variable.
bool is_definition(std::string_view line, std::string_view end) {
  const auto named =
      static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), is_name) - line.begin());
  if (named == 0) return false;
  line = without_blanks(line.substr(named));
  if (line.empty() || line.front() != '(' || !line.ends_with(end)) return false;
  return without_blanks(line.substr(0, line.size() - end.size())).ends_with(')');
}

bool is_comment(std::string_view line) {
  return line.front() == ';' || line.front() == '!' || line.front() == '#' || line.starts_with("$$");
}

/// Whether `line` is one of `words`, '(' and more text.
bool begins_with_call(std::string_view line, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return begins_with(line, word, false) && without_blanks(line.substr(word.size())).starts_with('(');
  });
}

/// Whether `line` is one of the major words of APT, '/' and more text.
bool begins_like_apt(std::string_view line) {
  static constexpr auto words = std::to_array<std::string_view>(
      {"GOTO", "FROM", "UNITS", "UNIT", "MACHIN", "CUTTER", "LOADTL", "TLDATA", "MULTAX", "PPRINT",
       "TOOL PATH", "MSYS", "CSYS", "FEDRAT", "SPINDL", "PAINT"});
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return begins_with(line, word, true) && without_blanks(line.substr(word.size())).starts_with('/');
  });
}

std::string_view dialect_of(std::string_view line) {
  if (line.size() > 1 && line[0] == '&' && std::isalpha(static_cast<unsigned char>(line[1])) != 0)
    return kuka_name;
  if (begins_with(line, "DEFDAT", true)) return kuka_name;
  if (begins_with(line, "DEF", true) && is_definition(without_blanks(line.substr(3)), "")) return kuka_name;
  if (begins_with(line, "def", false) && is_definition(without_blanks(line.substr(3)), ":")) return ur_name;
  if (begins_with_call(line, {"movej", "movel", "movep", "set_tcp"})) return ur_name;
  if (line == "%%%" || begins_with(line, "MODULE", true)) return abb_name;
  if (begins_with(line, "/PROG", true)) return tp_name;
  if (begins_with(line, "/JOB", true)) return yaskawa_name;
  if (begins_with(line, "PARTNO", true) || begins_like_apt(line)) return apt_name;
  return {};
}

}  // namespace

std::string_view robot_dialect(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    if (!line.empty() && !is_comment(line)) return dialect_of(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

}  // namespace counterflex
