#include "program/robot/ur/kept_words.hpp"

#include "program/robot/ur/lex.hpp"

namespace counterflex {

void describe_ur_statement(std::string_view text, const Move& move, StatementForm& form) {
  const auto call = ur_call_in_line(text, move.block.begin);
  if (!call) return;
  for (const std::string_view name : {"pose", "pose_to", "r"})
    if (const UrArgument* argument = ur_argument(text, *call, name))
      form.ignored.push_back({argument->span.begin, argument->value.begin});
  const UrArgument* mode = move.arc ? ur_argument(text, *call, "mode") : nullptr;
  if (mode != nullptr && mode != call->arguments.data())
    form.ignored.push_back({(mode - 1)->span.end, mode->span.end});
  if (!move.words[0] || ur_number(text, move.words[0]->number)) return;
  form.replaced = move.words[0]->number;
  form.replacement = "p[,,,,,]";
}

}  // namespace counterflex
