#include "program/robot/yaskawa/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "program/robot/yaskawa/motion.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_in_line(Span span, const RobotLine& line) {
  return span.begin >= line.span.begin && span.end <= line.span.end;
}

/// The tool of the point between the ends of a circle turns with that of the end: a circle with one
/// orientation keeps it.
void turn_auxiliary_point(std::string_view text, const Move& move, const TargetNumbers& numbers,
                          std::vector<TextChange>& changes) {
  constexpr std::size_t first_angle = 3;
  const std::size_t newline = text.rfind('\n', move.arc->centre_words[0]->number.begin);
  const auto point = jbi_values(text, newline == std::string_view::npos ? 0 : newline + 1);
  for (std::size_t i = 0; point && i < 3; ++i)
    if (numbers.orientation[i]) {
      const Span span = point->numbers[first_angle + i].span;
      changes.push_back(
          {span, number_text(text, span, numbers.orientation[i]->value, numbers.orientation[i]->decimals)});
    }
}

}  // namespace

YaskawaWriter::YaskawaWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, jbi_comment),
      job_(jbi_job(window.text, window.file)),
      first_free_(first_free_number(job_.positions)) {}

Rewritten YaskawaWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  added_.clear();
  Rewritten out = RobotWriter::write(window, edits);
  if (!added_.empty()) out.text = with_new_positions(out.text, window.file, added_);
  return out;
}

/// Behind NOP, else before the first instruction.
std::size_t YaskawaWriter::header_position(const Program& program) const {
  RobotLine line;
  line.line_end.end = job_.positions.end;
  while (next_robot_line(program.text, jbi_comment, line)) {
    if (empty(line.code) || program.text[line.code.begin] == '/') continue;
    return jbi_word(part(program.text, line.code)) == "NOP" ? line.line_end.end : line.span.begin;
  }
  return program.text.size();
}

void YaskawaWriter::add_position(const Program& program, const JbiName& name, bool is_copy,
                                 std::vector<TextChange>& own, std::vector<TextChange>& changes) const {
  const JbiPosition* position = job_.positions.find(name.family, name.number);
  const auto values = position != nullptr ? jbi_values(program.text, position->line_begin) : std::nullopt;
  if (!values) return;
  const std::uint32_t number = first_free_ + static_cast<std::uint32_t>(added_.size());
  added_.push_back({name, with_changes(program.text, values->text, own), is_copy, number});
  const std::string_view letter = part(program.text, {name.span.begin, name.digits.begin});
  const bool variable = is_variable(name.family);
  changes.push_back({name.span, fmt::format("{}{:05}", variable ? "C" : letter, number)});
}

/// The values of a position are changed in its line if only this step uses it. Otherwise, and for a copy, the
/// step gets a position of its own.
void YaskawaWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                                  std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  const JbiMotion motion = jbi_motion(text, jbi_line_at(text, move.block.begin).code);
  if (!motion.target) return;
  const JbiPosition* position = job_.positions.find(motion.target->family, motion.target->number);
  if (position == nullptr) return;
  std::vector<TextChange> all, own;
  RobotWriter::change_target(program, move, numbers, all);
  const RobotLine line = jbi_line_at(text, position->line_begin);
  for (TextChange& change : all) (is_in_line(change.span, line) ? own : changes).push_back(std::move(change));
  if (move.arc && move.arc->through && !numbers.is_copy) turn_auxiliary_point(text, move, numbers, changes);
  if (!numbers.is_copy && own.empty()) return;
  if (!numbers.is_copy && has_one_use(job_, *position)) {
    changes.insert(changes.end(), own.begin(), own.end());
    return;
  }
  add_position(program, *motion.target, numbers.is_copy, own, changes);
  std::vector<TextChange> none;
  for (const auto& name : {motion.base, motion.station})
    if (name) add_position(program, *name, numbers.is_copy, none, changes);
}

std::string YaskawaWriter::smaller_zone(const Program& program, const TargetZone& zone,
                                        double spacing_mm) const {
  const double most_mm = std::max(spacing_mm / 2, zone.least_mm);
  return number_text(program.text, zone.words, std::floor(most_mm * 10) / 10, 1);
}

}  // namespace counterflex
