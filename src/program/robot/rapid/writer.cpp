#include "program/robot/rapid/writer.hpp"

#include <algorithm>
#include <map>

#include "program/robot/rapid/motion.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr int decimals_of_kept_number = 9;

bool is_inside(Span inner, Span outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

/// Changes of all coordinates of a target that Offs or RelTool displaces: its list has those of the other
/// target.
void change_position(std::string_view text, const RapidOperand& operand, const Move& move,
                     const TargetNumbers& numbers, std::vector<TextChange>& changes) {
  std::erase_if(changes, [&](const TextChange& change) {
    return std::ranges::any_of(operand.target.position,
                               [&](const auto& number) { return number->span.begin == change.span.begin; });
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Span span = operand.target.position[axis]->span;
    const double end_mm = move.end_mm[static_cast<Eigen::Index>(axis)];
    const WordNumber number =
        numbers.position[axis].value_or(WordNumber{true, end_mm, decimals_of_kept_number});
    changes.push_back({span, number_text(text, span, number.value, number.decimals)});
  }
}

/// The part of `changes` that is in the list of `operand`.
std::vector<TextChange> changes_of(std::string_view text, const RapidOperand& operand, const Move& move,
                                   const TargetNumbers& numbers, const std::vector<TextChange>& changes) {
  std::vector<TextChange> own;
  for (const TextChange& change : changes)
    if (is_inside(change.span, operand.numbers)) own.push_back(change);
  if (operand.form == RapidOperand::Form::derived && (numbers.is_copy || !own.empty()))
    change_position(text, operand, move, numbers, own);
  return own;
}

/// "MoveC p1, p2, ..." becomes "MoveL p2, ...": the keyword, and the first target with its comma.
void change_to_line(Span keyword, const std::vector<RapidOperand>& targets,
                    std::vector<TextChange>& changes) {
  changes.push_back({{keyword.end - 1, keyword.end}, "L"});
  changes.push_back({{targets[0].span.begin, targets[1].span.begin}, ""});
}

}  // namespace

RapidWriter::RapidWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, rapid_comment) {
  if (rapid_depends_on_far_lines(window.text)) module_.scan(window.text, {});
}

/// Behind the line of MODULE: before it only the version of the format is allowed.
std::size_t RapidWriter::header_position(const Program& program) const {
  const std::string_view text = program.text;
  RapidStatement statement;
  do statement = rapid_statement_at(text, statement.behind, text.size());
  while (statement.kind == RapidKind::declaration && statement.head.empty());
  if (statement.kind != RapidKind::module_begin) return byte_order_mark(text);
  const std::size_t newline = text.find('\n', statement.behind);
  return newline == std::string_view::npos ? text.size() : newline + 1;
}

/// A name gets a list with the new numbers in its place. If all uses of the name get the same list,
/// `finish_changes` changes its declaration instead.
void RapidWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                                std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  const RapidStatement statement = rapid_statement_at(text, move.block.begin, move.block.end);
  const RapidPlace place{text, module_, statement.span.begin};
  const RapidMotion motion = rapid_motion(text, statement);
  if (!motion.complete) return;
  std::vector<RapidOperand> targets;
  for (const Span target : motion.targets) targets.push_back(rapid_operand(place, target));
  std::vector<TextChange> all;
  RobotWriter::change_target(program, move, numbers, all);
  for (const RapidOperand& operand : targets) {
    if (numbers.becomes_line && &operand == &targets.front()) continue;
    std::vector<TextChange> own = changes_of(text, operand, move, numbers, all);
    if (operand.form == RapidOperand::Form::list)
      changes.insert(changes.end(), own.begin(), own.end());
    else if (numbers.is_copy || !own.empty())
      changes.push_back({operand.span, in_one_line(with_changes(text, operand.numbers, own))});
  }
  const Span keyword = rapid_token_at(text, statement.span.begin, statement.span.end).span;
  if (numbers.becomes_line) change_to_line(keyword, targets, changes);
}

std::string RapidWriter::smaller_zone(const Program&, const TargetZone&, double spacing_mm) const {
  return rapid_zone_within(spacing_mm / 2);
}

/// A declaration is changed if all uses of its name are targets that get the same numbers, to the last digit.
void RapidWriter::finish_changes(const Program& program, const std::vector<MoveEdit>&,
                                 std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  std::map<const RapidDatum*, std::vector<std::size_t>> uses;  // changes of each datum
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const RapidToken name = rapid_token_at(text, changes[i].span.begin, changes[i].span.end);
    if (name.kind != RapidTokenKind::name || name.span.end != changes[i].span.end) continue;
    const RapidDatum* datum = module_.find(part(text, name.span), name.span.begin);
    if (datum != nullptr && datum->type == "ROBTARGET") uses[datum].push_back(i);
  }
  std::vector<std::size_t> merged;
  std::vector<TextChange> declared;
  for (const auto& [datum, indices] : uses) {
    const std::string& first = changes[indices.front()].text;
    const bool same = std::ranges::all_of(indices, [&](std::size_t i) { return changes[i].text == first; });
    const bool in_line = part(text, datum->span).find_first_of("\n!") == std::string_view::npos;
    if (!same || !in_line || indices.size() != datum->uses) continue;
    declared.push_back({datum->span, first});
    merged.insert(merged.end(), indices.begin(), indices.end());
  }
  for (const std::size_t i : merged) changes[i] = {{text.size(), text.size()}, ""};
  changes.insert(changes.end(), declared.begin(), declared.end());
}

}  // namespace counterflex
