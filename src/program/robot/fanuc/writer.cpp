#include "program/robot/fanuc/writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/robot/fanuc/numbering.hpp"
#include "program/robot/fanuc/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// The motion statement of `move`.
TpMotion motion_at(const Program& program, const Move& move) {
  RobotLine line;
  line.line_end.end = move.block.begin;
  next_tp_line(program.text, TpSection::statements, line);
  return tp_motion(program.text, line.code);
}

bool is_in(Span inner, Span outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

/// The change of a number in its column: blanks before it are taken or added so that the text behind it stays
/// in its place. One blank remains.
TextChange in_column(std::string_view text, TextChange change) {
  std::size_t blanks = 0;
  while (text[change.span.begin - blanks - 1] == ' ') ++blanks;
  const std::size_t old_size = change.span.end - change.span.begin;
  change.text.erase(0, std::min(change.text.find_first_not_of(' '), change.text.size()));
  if (blanks < 2) return change;
  if (change.text.size() < old_size)
    change.text = std::string(old_size - change.text.size(), ' ').append(change.text);
  if (change.text.size() > old_size) change.span.begin -= std::min(change.text.size() - old_size, blanks - 1);
  return change;
}

/// "C P[1] : P[2] 100mm/sec FINE" becomes "L P[2] 100mm/sec FINE".
void change_to_line(std::string_view text, const Move& move, const TpMotion& motion,
                    std::vector<TextChange>& changes) {
  if (motion.operands.size() != 2) return;
  const std::size_t colon = text.find(':', move.block.begin);
  const std::size_t letter = behind_blanks(text, colon + 1, move.block.end);
  changes.push_back({{letter, letter + 1}, "L"});
  changes.push_back({{motion.operands[0].span.begin, motion.operands[1].span.begin}, ""});
}

/// The content of a position: behind its number and its comment.
Span content_of(std::string_view text, const TpPosition& position) {
  return {std::min(text.find('{', position.span.begin), position.span.end), position.span.end};
}

}  // namespace

FanucWriter::FanucWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, tp_comment), file_(tp_file(window.file, window.text)) {
  if (!file_.positions.empty()) largest_ = file_.positions.rbegin()->first;
}

/// Behind the line of /MN.
std::size_t FanucWriter::header_position(const Program& program) const {
  for (RobotLine line; next_physical_line(program.text, line);)
    if (tp_section(part(program.text, line.span)) == TpSection::statements) return line.line_end.end;
  return program.text.size();
}

std::string FanucWriter::header_text(const std::string& line) const {
  return tp_remarks(line, line_end());
}

Span FanucWriter::copied_part(const Program&, const Move& move) const {
  return move.block;
}

long FanucWriter::number_of_new(const Move& move, std::string content) const {
  const auto [found, is_new] = number_of_content_.try_emplace(std::move(content), 0);
  if (!is_new) return found->second;
  new_contents_.push_back(found->first);
  found->second = largest_ + static_cast<long>(new_contents_.size());
  const auto most = static_cast<long>(options().most_points);
  if (most > 0 && found->second > most && line_beyond_ == 0) line_beyond_ = move.line;
  return found->second;
}

/// A copy gets positions of its own. For the statement itself `finish_changes` decides, when all motions to
/// its position are known.
void FanucWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                                std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  const TpMotion motion = motion_at(program, move);
  std::vector<TextChange> all;
  RobotWriter::change_target(program, move, numbers, all);
  for (const TpOperand& operand : motion.operands) {
    if (numbers.becomes_line && &operand == &motion.operands.front()) continue;
    const TpPosition& position = file_.positions.find(*operand.number)->second;
    std::vector<TextChange> own;
    for (const TextChange& change : all)
      if (is_in(change.span, position.span)) own.push_back(in_column(text, change));
    std::string content = with_changes(text, content_of(text, position), own);
    if (numbers.is_copy)
      changes.push_back({operand.span, fmt::format("P[{}]", number_of_new(move, std::move(content)))});
    else
      uses_[*operand.number].push_back({&move, operand.span, std::move(content)});
  }
  if (numbers.becomes_line) change_to_line(text, move, motion, changes);
}

/// The position keeps its number for motions that leave it unchanged, else for the first one. The others get
/// new numbers. If a statement that is not edited uses the position, it stays.
void FanucWriter::place_position(const Program& program, long number,
                                 std::vector<TextChange>& changes) const {
  const TpPosition& position = file_.positions.find(number)->second;
  const std::vector<Use>& uses = uses_.find(number)->second;
  const Span span = content_of(program.text, position);
  const std::string_view original = part(program.text, span);
  std::string_view kept = original;
  const bool stays = file_.computed_index || uses.size() != position.uses ||
                     std::ranges::any_of(uses, [&](const Use& use) { return use.content == original; });
  if (!stays) kept = uses.front().content;
  if (!stays) changes.push_back({span, uses.front().content});
  for (const Use& use : uses)
    if (use.content != kept)
      changes.push_back({use.operand, fmt::format("P[{}]", number_of_new(*use.move, use.content))});
}

void FanucWriter::finish_changes(const Program& program, const std::vector<MoveEdit>&,
                                 std::vector<TextChange>& changes) const {
  for (const auto& [number, uses] : uses_) place_position(program, number, changes);
  if (new_contents_.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < new_contents_.size(); ++i)
    text += fmt::format("P[{}]{}{}", largest_ + static_cast<long>(i) + 1, new_contents_[i], line_end());
  const TpPosition& last = std::ranges::max_element(file_.positions, {}, [](const auto& p) {
                             return p.second.span.begin;
                           })->second;
  const std::size_t newline = program.text.find('\n', last.span.end);
  const std::size_t end = newline == std::string::npos ? program.text.size() : newline + 1;
  if (newline == std::string::npos) text.insert(0, line_end());
  changes.push_back({{end, end}, std::move(text)});
}

Rewritten FanucWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  Rewritten out = RobotWriter::write(window, edits);
  const bool inserted = out.inserted_blocks > 0 || !options().header.empty() || options().guard;
  if (inserted && file_.numbered)
    out.text = with_numbered_lines(std::move(out.text), file_.line_count.has_value());
  const std::size_t before = static_cast<std::size_t>(largest_);
  out.points = {before, before + new_contents_.size(), line_beyond_};
  return out;
}

}  // namespace counterflex
