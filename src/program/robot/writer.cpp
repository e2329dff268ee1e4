#include "program/robot/writer.hpp"

#include <algorithm>
#include <cassert>
#include <span>

#include "program/dialect.hpp"
#include "program/guard/guard_text.hpp"
#include "program/robot/spacing.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {

/// A window being written.
struct RobotWriter::Output {
  const Program& program;
  std::vector<TextChange> changes{};
  Rewritten out{};
};

namespace {

std::string line_end_of(std::string_view text) {
  const std::size_t newline = text.find('\n');
  return newline != std::string_view::npos && newline > 0 && text[newline - 1] == '\r' ? "\r\n" : "\n";
}

std::string comment_text(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c >= 0x20 && c < 0x7f ? c : ' ';
  return safe;
}

/// The numbers of the statement itself: those that `step` changes or inserts.
TargetNumbers changed_numbers(const Move& move, const Step& step) {
  TargetNumbers numbers;
  numbers.becomes_line = move.arc && !step.arc;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.arc && step.arc->centre[axis].write) numbers.through[axis] = step.arc->centre[axis];
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.axes[axis].number.write) numbers.position[axis] = step.axes[axis].number;
  for (std::size_t i = 0; i < step.angles.size(); ++i)
    if (step.angles[i].write) numbers.orientation[i] = step.angles[i];
  if (step.after.orientation) numbers.turned = *step.after.orientation;
  return numbers;
}

/// The numbers of a copy of the statement: those in which it differs. A number that the step does not write
/// is that of the text before.
TargetNumbers copied_numbers(const Move& move, const Step& step) {
  constexpr int all_decimals = 9;
  TargetNumbers numbers = changed_numbers(move, step);
  numbers.is_copy = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!move.words[axis] || numbers.position[axis]) continue;
    const double before = move.relative ? 0 : in_unit(step.before[axis].value_or(0), move.unit);
    const double end_mm = component(move.end_mm, axis) - (move.relative ? component(move.start_mm, axis) : 0);
    if (before != in_unit(end_mm, move.unit)) numbers.position[axis] = WordNumber{true, before, all_decimals};
  }
  if (!move.orientation) return numbers;
  for (std::size_t i = 0; i < number_count(move.orientation->form); ++i) {
    std::optional<WordNumber>& number = numbers.orientation[i];
    if (!move.orientation->words[i]) continue;
    if (!number) number = WordNumber{true, step.angles[i].value, all_decimals};
    if (number->value == move.orientation->end[i]) number.reset();
  }
  return numbers;
}

std::size_t count(const TargetNumbers& numbers, const Move& move, bool with_word) {
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    count += (numbers.position[axis] && move.words[axis].has_value() == with_word) +
             (numbers.through[axis] && with_word);
  for (std::size_t i = 0; move.orientation && i < numbers.orientation.size(); ++i)
    count += numbers.orientation[i] && move.orientation->words[i].has_value() == with_word;
  return count;
}

/// The shorter distance (mm) of each inserted point to those beside it. `start`: where the move begins.
std::vector<double> spacings_of(const std::optional<Vector3>& start, std::vector<Vector3> points) {
  if (start) points.insert(points.begin(), *start);
  std::vector<double> spacings;
  for (std::size_t i = start ? 1 : 0; i + 1 < points.size(); ++i) {
    const auto behind = std::span(points).subspan(i + 1);
    const auto before = std::span(points).first(i);
    std::vector<Vector3> back(before.rbegin(), before.rend());
    spacings.push_back(std::min(distance_to_next(points[i], back), distance_to_next(points[i], behind)));
  }
  return spacings;
}

/// Counts the target of `move` and the points inserted before it.
void count_points(const Move& move, std::size_t inserted, std::size_t most, PointCount& points) {
  ++points.before;
  points.after += inserted + 1;
  if (most > 0 && points.after > most && points.first_line_beyond == 0) points.first_line_beyond = move.line;
}

}  // namespace

std::string with_changes(std::string_view text, Span within, std::vector<TextChange>& changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const TextChange& a, const TextChange& b) { return a.span.begin < b.span.begin; });
  std::string result;
  result.reserve(within.end - within.begin + changes.size() * 8);
  std::size_t copied = within.begin;
  for (const TextChange& change : changes) {
    assert(change.span.begin >= copied && change.span.end <= within.end);
    result.append(text, copied, change.span.begin - copied).append(change.text);
    copied = change.span.end;
  }
  return result.append(text, copied, within.end - copied);
}

std::string number_text(std::string_view text, Span number, double value, int decimals) {
  // An exponent would be taken for digits behind the point.
  const std::string_view whole = part(text, number), original = whole.substr(0, whole.find_first_of("eE"));
  std::string changed = changed_number(original, value, decimals);
  if (changed.back() == '.' && original.back() != '.') changed.pop_back();
  // The sign of "X-5" separates the number from its name.
  const bool touches_name = number.begin > 0 && is_identifier_character(text[number.begin - 1]);
  if (touches_name && changed.front() != '-' && changed.front() != '+') changed.insert(0, " ");
  return changed;
}

RobotWriter::RobotWriter(const Program& window, const WriteOptions& options, std::string_view comment_mark)
    : options_(options), comment_mark_(comment_mark), line_end_(line_end_of(window.text)) {}

void RobotWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                                std::vector<TextChange>& changes) const {
  const auto change = [&](const PackedAxisWord& word, const std::optional<WordNumber>& number) {
    if (word && number)
      changes.push_back(
          {word->number, number_text(program.text, word->number, number->value, number->decimals)});
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    change(move.words[axis], numbers.position[axis]);
    if (move.arc && !numbers.becomes_line) change(move.arc->centre_words[axis], numbers.through[axis]);
  }
  for (std::size_t i = 0; move.orientation && i < numbers.orientation.size(); ++i)
    change(move.orientation->words[i], numbers.orientation[i]);
}

std::string RobotWriter::header_text(const std::string& line) const {
  return std::string(comment_mark_).append(" ").append(line).append(line_end_);
}

std::string RobotWriter::smaller_zone(const Program& program, const TargetZone& zone, double) const {
  return std::string(part(program.text, zone.words));
}

std::map<std::size_t, double> RobotWriter::zone_spacings(const Program& program,
                                                         const std::vector<MoveEdit>& edits) const {
  return spacing_at_targets(program, edits, options_);
}

/// Makes the zone in the statement of `move` at most half of `spacing_mm`, but not smaller than the language
/// can write.
void RobotWriter::limit_zone(const Program& program, const Move& move, double spacing_mm,
                             std::vector<TextChange>& changes) const {
  if (!move.zone || move.zone->length_mm <= std::max(spacing_mm / 2, move.zone->least_mm)) return;
  changes.push_back({move.zone->words, smaller_zone(program, *move.zone, spacing_mm)});
}

Span RobotWriter::copied_part(const Program& program, const Move& move) const {
  RobotLine line;
  const std::string_view text = part(program.text, move.block);
  next_robot_line(text, comment_mark_, line);
  return {move.block.begin, move.block.begin + line.code.end};
}

void RobotWriter::finish_changes(const Program&, const std::vector<MoveEdit>&,
                                 std::vector<TextChange>&) const {}

void RobotWriter::insert_point(const Move& move, const Via& via, int motion, double spacing_mm,
                               std::string& text, Output& o) {
  const Step step = round_step(move, position_, via, motion, Place::inside, options_);
  if (equals_text_position(step)) return;
  std::vector<TextChange> changes;
  change_target(o.program, move, copied_numbers(move, step), changes);
  limit_zone(o.program, move, spacing_mm, changes);
  text += with_changes(o.program.text, copied_part(o.program, move), changes) + line_end_;
  ++o.out.inserted_blocks;
  position_ = step.after;
}

void RobotWriter::write_move(const MoveEdit& edit, Output& o) {
  const Move& move = o.program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split);
  assert(!edit.jump || move.may_jump);
  position_ = known_text_position(move, position_);
  const std::vector<double> spacings =
      spacings_of(position_.place_mm(), written_points(move, &edit, options_));
  auto spacing = spacings.begin();
  std::string before;
  if (edit.jump) insert_point(move, *edit.jump, 1, *spacing++, before, o);
  for (const Via& via : edit.inserted) insert_point(move, via, motion_of(move), *spacing++, before, o);
  if (!before.empty()) o.changes.push_back({{move.block.begin, move.block.begin}, std::move(before)});
  const Via end{edit.end_mm, edit.centre_mm, edit.orientation};
  const Step step = round_step(move, position_, end, motion_of(move), Place::end, options_);
  const TargetNumbers numbers = changed_numbers(move, step);
  change_target(o.program, move, numbers, o.changes);
  o.out.changed_words += count(numbers, move, true);
  o.out.inserted_words += count(numbers, move, false);
  position_ = step.after;
}

void RobotWriter::add_header(Output& o) const {
  if (options_.header.empty()) return;
  const std::size_t position = header_position(o.program);
  std::string text;
  for (const std::string& line : options_.header) text += header_text(comment_text(line));
  const std::string_view before = std::string_view(o.program.text).substr(0, position);
  if (position > byte_order_mark(before) && before.back() != '\n') text.insert(0, line_end_);
  o.changes.push_back({{position, position}, std::move(text)});
}

Rewritten RobotWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  Output o{window};
  if (!begun_) add_header(o);
  begun_ = true;
  if (const Move* cut = options_.guard && !guarded_ ? first_cut(window) : nullptr; cut != nullptr) {
    const std::size_t at = cut->block.begin;
    o.changes.push_back({{at, at}, guard_text(window.dialect, *options_.guard, line_end_)});
    guarded_ = true;
  }
  std::size_t next = 0;
  const auto count = [&](std::size_t inserted) {
    count_points(window.moves[next], inserted, options_.most_points, points_);
  };
  const auto keep_until = [&](std::size_t end) {
    for (; next < end; ++next) {
      position_ = text_position_after_original(window.moves[next], position_);
      count(0);
    }
  };
  for (const MoveEdit& edit : edits) {
    keep_until(edit.move);
    const std::size_t inserted = o.out.inserted_blocks;
    write_move(edit, o);
    o.out.blocks_of_edit.push_back(o.out.inserted_blocks - inserted);
    count(o.out.blocks_of_edit.back());
    next = edit.move + 1;
  }
  keep_until(window.moves.size());
  o.out.points = points_;
  for (const auto& [move, spacing_mm] : zone_spacings(window, edits))
    limit_zone(window, window.moves[move], spacing_mm, o.changes);
  finish_changes(window, edits, o.changes);
  o.out.text = with_changes(window.text, {0, window.text.size()}, o.changes);
  return std::move(o.out);
}

}  // namespace counterflex
