#include "program/robot/apt/writer.hpp"

#include <algorithm>

#include "program/robot/apt/lex.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {

AptWriter::AptWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, apt_comment) {}

/// Behind PARTNO, which is the first statement of a program.
std::size_t AptWriter::header_position(const Program& program) const {
  RobotLine line;
  while (next_apt_line(program.text, line)) {
    if (empty(line.code)) continue;
    if (apt_statement(program.text, line.code).head.starts_with("PARTNO")) return line.line_end.end;
    break;
  }
  return byte_order_mark(program.text);
}

/// A point without an axis gets all three numbers of it.
void AptWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                              std::vector<TextChange>& changes) const {
  RobotWriter::change_target(program, move, numbers, changes);
  const bool turns = std::ranges::any_of(numbers.orientation, [](const auto& n) { return n.has_value(); });
  if (!turns || !move.orientation || move.orientation->words[0]) return;
  constexpr int decimals = 6;
  std::string axis;
  for (std::size_t i = 0; i < 3; ++i) axis += "," + inserted_number(numbers.turned[i], decimals);
  const std::size_t end = move.words[2]->number.end;
  changes.push_back({{end, end}, std::move(axis)});
}

Span AptWriter::copied_part(const Program& program, const Move& move) const {
  RobotLine line;
  next_apt_line(part(program.text, move.block), line);
  return {move.block.begin, move.block.begin + line.code.end};
}

}  // namespace counterflex
