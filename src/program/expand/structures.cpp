#include "program/expand/structures.hpp"

#include "program/expand/definitions.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {

void follow_structures(std::string_view text, const Dialect& dialect, const Block& block,
                       Structures& structures) {
  if (empty(block.flow_keyword)) return;
  std::vector<std::string>& open = structures.open;
  const std::string_view keyword = part(text, block.flow_keyword);
  const auto is = [&](std::string_view word) { return is_word(keyword, word); };
  const std::string name = normal_name(part(text, block.flow_name));
  const bool closes_do = dialect.o_words && is("WHILE") && !open.empty() && open.back() == name + " do";
  if (is("ENDIF") || is("ENDWHILE") || is("ENDREPEAT") || is("END") || closes_do) {
    if (!open.empty()) open.pop_back();
  } else if (is("WHILE") || is("DO") || (dialect.o_words && (is("IF") || is("REPEAT")))) {
    open.push_back(is("DO") ? name + " do" : name);
  }
}

}  // namespace counterflex
