#include "counterflex/program/kept_words.hpp"

#include <algorithm>
#include <string_view>

#include "program/dialect.hpp"
#include "program/klartext/kept_words.hpp"
#include "program/robot/apt/lex.hpp"
#include "program/robot/fanuc/kept_words.hpp"
#include "program/robot/kept_words.hpp"
#include "program/robot/kuka/lex.hpp"
#include "program/robot/rapid/lex.hpp"
#include "program/robot/ur/lex.hpp"
#include "program/robot/yaskawa/kept_words.hpp"
#include "program/text/scanner.hpp"
#include "program/write/kept_words.hpp"

namespace counterflex {

std::string kept_words(const Program& program, const Move& move) {
  if (program.dialect == klartext_name) return klartext_kept_words(program, move);
  if (program.dialect == kuka_name) return statement_kept_words(program, move, krl_comment);
  if (program.dialect == abb_name) return statement_kept_words(program, move, rapid_comment);
  if (program.dialect == ur_name) return statement_kept_words(program, move, ur_comment);
  if (program.dialect == apt_name) return statement_kept_words(program, move, apt_comment);
  if (program.dialect == tp_name) return tp_kept_words(program, move);
  if (program.dialect == yaskawa_name) return jbi_kept_words(program, move);
  return gcode_kept_words(program, move);
}

bool are_alike(const std::string& a, const std::string& b) {
  const std::size_t named = a.find('@');
  if (named == std::string::npos && b.find('@') != std::string::npos) return are_alike(b, a);
  if (named == std::string::npos || a == b) return a == b;
  // The other has its numbers in the statement: between the same words is at least one bracket.
  const std::string_view head = std::string_view(a).substr(0, named),
                         tail = std::string_view(a).substr(named + 1);
  if (b.size() < a.size() || !b.starts_with(head) || !b.ends_with(tail)) return false;
  std::string_view target = std::string_view(b).substr(named, b.size() - head.size() - tail.size());
  if (target.starts_with('p')) target.remove_prefix(1);  // p[0.1, 0.2, ...]
  return (target.starts_with('{') && target.ends_with('}')) ||
         (target.starts_with('[') && target.ends_with(']'));
}

bool is_plain(const std::string& words) {
  for (std::size_t i = 0; i < words.size() && words[i] != ';'; ++i) {
    const char c = upper(words[i]);
    if (c == '(') i = std::min(words.find(')', i), words.size() - 1);
    if (c >= 'A' && c <= 'Z' && c != 'F') return false;
    if (c == 'F' && words.compare(i, 4, "FMAX") == 0) i += 3;
  }
  return true;
}

}  // namespace counterflex
