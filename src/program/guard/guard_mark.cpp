#include "program/guard/guard_mark.hpp"

#include <algorithm>

#include "counterflex/files/files.hpp"

namespace counterflex {
namespace {

constexpr std::string_view mark_begin = "CF ";
constexpr std::size_t digits = 8, mark_size = mark_begin.size() + digits;

std::string_view without_blanks(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t begin = std::min(line.find_first_not_of(blanks), line.size());
  return line.substr(begin, line.find_last_not_of(blanks) + 1 - begin);
}

}  // namespace

std::string guard_mark(std::string_view before, std::string_view behind) {
  std::string hash = sha256(std::string(before).append(1, '\n').append(behind)).substr(0, digits);
  std::transform(hash.begin(), hash.end(), hash.begin(),
                 [](char c) { return c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c; });
  return std::string(mark_begin) + hash;
}

std::string marked_line(std::string_view before, std::string_view behind) {
  return std::string(before) + guard_mark(before, behind) + std::string(behind);
}

bool is_guard_line(std::string_view line) {
  if (line.rfind(mark_begin) == std::string_view::npos) return false;
  line = without_blanks(line);
  const std::size_t at = line.rfind(mark_begin);
  if (at == std::string_view::npos || at + mark_size > line.size()) return false;
  return line.substr(at, mark_size) == guard_mark(line.substr(0, at), line.substr(at + mark_size));
}

}  // namespace counterflex
