#include "program/robot/rapid/kept_words.hpp"

#include "program/robot/rapid/data.hpp"
#include "program/robot/rapid/motion.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

void describe_rapid_statement(std::string_view text, const Move& move, StatementForm& form) {
  if (part(text, move.block).find('(') == std::string_view::npos) return;
  const RapidStatement statement = rapid_statement_at(text, move.block.begin, move.block.end);
  for (const Span target : rapid_motion(text, statement).targets) {
    const std::vector<Span> arguments = rapid_displacement(text, target).arguments;
    if (arguments.empty()) continue;
    form.ignored.push_back({target.begin, arguments.front().begin});
    form.ignored.push_back({arguments.front().end, target.end});
  }
}

}  // namespace counterflex
