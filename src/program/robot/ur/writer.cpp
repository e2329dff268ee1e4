#include "program/robot/ur/writer.hpp"

#include <algorithm>
#include <cmath>

#include "program/dialect.hpp"
#include "program/robot/spacing.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// The pose that has the number at `number`.
std::optional<UrPose> pose_around(std::string_view text, std::size_t number) {
  const std::size_t begin = text.rfind("p[", number), end = text.find(']', number);
  if (begin == std::string_view::npos || end == std::string_view::npos) return std::nullopt;
  return ur_pose(text, {begin, end + 1});
}

void add(const PackedAxisWord& word, const std::optional<WordNumber>& number, std::string_view text,
         std::vector<TextChange>& changes) {
  if (word && number)
    changes.push_back({word->number, number_text(text, word->number, number->value, number->decimals)});
}

std::vector<TextChange> end_changes(std::string_view text, const Move& move, const TargetNumbers& numbers) {
  std::vector<TextChange> changes;
  for (std::size_t axis = 0; axis < 3; ++axis) add(move.words[axis], numbers.position[axis], text, changes);
  for (std::size_t i = 0; move.orientation && i < 3; ++i)
    add(move.orientation->words[i], numbers.orientation[i], text, changes);
  return changes;
}

std::vector<TextChange> point_changes(std::string_view text, const Move& move, const TargetNumbers& numbers) {
  std::vector<TextChange> changes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    add(move.arc->centre_words[axis], numbers.through[axis], text, changes);
  return changes;
}

/// Where the statement has its target: the pose itself, or its name.
Span operand_of(std::string_view text, const UrCall& call, bool auxiliary) {
  const bool circle = part(text, call.name) == "movec";
  const UrArgument* argument = ur_argument(text, call, auxiliary ? "pose_via" : circle ? "pose_to" : "pose");
  if (argument == nullptr) argument = ur_argument(text, call, "q");
  return argument ? ur_operand(text, argument->value) : Span{};
}

bool is_named(std::string_view text, Span operand) {
  return !part(text, operand).starts_with("p[");
}

/// Whether the target of `move` is given by joint values, for which a pose is written.
bool is_in_joints(std::string_view text, const Move& move) {
  return move.words[0] && !ur_number(text, move.words[0]->number);
}

/// "p[x,y,z,rx,ry,rz]" with `numbers`, and those of `move` in the place of numbers that stay.
std::string pose_text(const Move& move, const TargetNumbers& numbers) {
  constexpr int all_decimals = 9;
  std::string text = "p[";
  const auto add_number = [&](const std::optional<WordNumber>& number, double otherwise) {
    if (text.back() != '[') text += ',';
    text +=
        number ? inserted_number(number->value, number->decimals) : inserted_number(otherwise, all_decimals);
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    add_number(numbers.position[axis], in_unit(component(move.end_mm, axis), move.unit));
  for (std::size_t i = 0; i < 3; ++i) add_number(numbers.orientation[i], move.orientation->end[i]);
  return text + "]";
}

bool is_empty(const TargetNumbers& numbers) {
  const auto is_set = [](const std::optional<WordNumber>& number) { return number.has_value(); };
  return std::ranges::none_of(numbers.position, is_set) && std::ranges::none_of(numbers.orientation, is_set);
}

/// The pose with `own` changes of its numbers, in the place of its name.
void put_pose(std::string_view text, Span operand, std::vector<TextChange>& own,
              std::vector<TextChange>& changes) {
  if (own.empty()) return;
  if (const auto pose = pose_around(text, own.front().span.begin))
    changes.push_back({operand, with_changes(text, pose->span, own)});
}

/// "movec(via, to, a, v, r, mode=0)" becomes "movel(to, a, v, r=r)".
void change_to_line(std::string_view text, const UrCall& call, std::vector<TextChange>& changes) {
  const UrArgument *via = ur_argument(text, call, "pose_via"), *to = ur_argument(text, call, "pose_to"),
                   *zone = ur_argument(text, call, "r"), *mode = ur_argument(text, call, "mode");
  if (via == nullptr || to == nullptr) return;
  changes.push_back({call.name, "movel"});
  changes.push_back({{via->span.begin, to->span.begin}, ""});
  if (!empty(to->name)) changes.push_back({to->name, "pose"});
  if (zone != nullptr && empty(zone->name)) changes.push_back({{zone->span.begin, zone->span.begin}, "r="});
  if (mode != nullptr) changes.push_back({{(mode - 1)->span.end, mode->span.end}, ""});
}

}  // namespace

UrWriter::UrWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, ur_comment), names_(ur_names(window.text)) {}

/// Behind "def": the rest of the text may be sent to the control before it.
std::size_t UrWriter::header_position(const Program& program) const {
  RobotLine line;
  while (next_robot_line(program.text, ur_comment, line))
    if (part(program.text, ur_name_at(program.text, line.code.begin, line.code.end)) == "def")
      return line.line_end.end;
  return byte_order_mark(program.text);
}

void UrWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                             std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  const auto call = ur_call_in_line(text, move.block.begin);
  if (!call) return;
  if (is_in_joints(text, move)) {
    if (!is_empty(numbers)) changes.push_back({move.words[0]->number, pose_text(move, numbers)});
    return;
  }
  const auto put = [&](bool auxiliary, std::vector<TextChange> own) {
    const Span operand = operand_of(text, *call, auxiliary);
    if (is_named(text, operand)) return put_pose(text, operand, own, changes);
    changes.insert(changes.end(), own.begin(), own.end());
  };
  // The end of the statement itself: see change_named_targets.
  if (numbers.is_copy || !is_named(text, operand_of(text, *call, false)))
    put(false, end_changes(text, move, numbers));
  if (numbers.becomes_line)
    change_to_line(text, *call, changes);
  else if (move.arc)
    put(true, point_changes(text, move, numbers));
}

void UrWriter::finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                              std::vector<TextChange>& changes) const {
  change_named_targets(program, edits, changes);
}

void UrWriter::change_named_targets(const Program& program, const std::vector<MoveEdit>& edits,
                                    std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  struct Use {
    Span operand;
    std::vector<TextChange> own;
  };
  std::map<std::string, std::vector<Use>, std::less<>> by_name;
  for (const MoveEdit& edit : edits) {
    const Move& move = program.moves[edit.move];
    const bool has_pose = move.words[0] && !is_in_joints(text, move);
    const auto call = has_pose ? ur_call_in_line(text, move.block.begin) : std::nullopt;
    const Span operand = call ? operand_of(text, *call, false) : Span{};
    if (empty(operand) || !is_named(text, operand)) continue;
    const Step step = round_step(move, {}, {edit.end_mm, edit.centre_mm, edit.orientation}, motion_of(move),
                                 Place::end, options());
    TargetNumbers numbers;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (step.axes[axis].number.write) numbers.position[axis] = step.axes[axis].number;
    for (std::size_t i = 0; i < 3; ++i)
      if (step.angles[i].write) numbers.orientation[i] = step.angles[i];
    by_name[std::string(part(text, operand))].push_back({operand, end_changes(text, move, numbers)});
  }
  for (auto& [name, uses] : by_name) {
    const Use& first = uses.front();
    const auto is_like_first = [&first](const Use& use) {
      return std::ranges::equal(use.own, first.own, [](const TextChange& a, const TextChange& b) {
        return a.span.begin == b.span.begin && a.text == b.text;
      });
    };
    const auto variable = names_.variables.find(name);
    const bool only_these = variable != names_.variables.end() && variable->second.read == uses.size();
    if (only_these && std::ranges::all_of(uses, is_like_first)) {
      const auto& own = uses.front().own;
      changes.insert(changes.end(), own.begin(), own.end());
      continue;
    }
    for (Use& use : uses) put_pose(text, use.operand, use.own, changes);
  }
}

std::string UrWriter::smaller_zone(const Program& program, const TargetZone& zone, double spacing_mm) const {
  // Rounded down, and less than half: the zones at both ends do not overlap.
  constexpr double share = 0.49;
  const double most = share * spacing_mm / ur_length_mm;
  int decimals = resolution_decimals(LengthUnit::metres);
  if (most * power_of_ten(decimals) < 1) decimals += 2;  // a radius of zero would stop the robot
  const double radius = std::floor(most * power_of_ten(decimals)) / power_of_ten(decimals);
  const bool plain = ur_number(program.text, zone.words).has_value();
  return plain ? number_text(program.text, zone.words, radius, decimals) : inserted_number(radius, decimals);
}

/// A move is skipped by the control if the zones at its ends overlap. Beside an inserted point a zone is at
/// most half the distance to it. Zones that touch in the original still do not overlap.
std::map<std::size_t, double> UrWriter::zone_spacings(const Program& program,
                                                      const std::vector<MoveEdit>& edits) const {
  std::map<std::size_t, double> spacings_mm = spacing_at_targets(program, edits, options());
  const auto zone_at_end = [](const Move& move) { return move.zone ? move.zone->length_mm : 0; };
  for (std::size_t m = 1; m < program.moves.size(); ++m) {
    const Move &move = program.moves[m], &before = program.moves[m - 1];
    if (!all_known(move.known_start) || !all_known(move.known_end) || !all_known(before.known_end)) continue;
    const std::vector<Vector3> points = written_points(move, edit_of(edits, m), options());
    if (points.size() > 1) continue;
    const Vector3 start = written_points(before, edit_of(edits, m - 1), options()).back();
    const double length_mm = (points.front() - start).norm();
    const double both_mm = zone_at_end(before) + zone_at_end(move);
    if (both_mm <= length_mm || both_mm > (move.end_mm - move.start_mm).norm()) continue;
    limit_spacing(spacings_mm, m - 1, length_mm);
    limit_spacing(spacings_mm, m, length_mm);
  }
  return spacings_mm;
}

}  // namespace counterflex
