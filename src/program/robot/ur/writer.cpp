#include "program/robot/ur/writer.hpp"

#include <algorithm>
#include <cmath>

#include "program/dialect.hpp"
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

const MoveEdit* edit_of(const std::vector<MoveEdit>& edits, std::size_t move) {
  const auto at = std::lower_bound(edits.begin(), edits.end(), move,
                                   [](const MoveEdit& edit, std::size_t m) { return edit.move < m; });
  return at != edits.end() && at->move == move ? &*at : nullptr;
}

/// The points of `edit` in order: the inserted ones and the end.
std::vector<Vector3> points_of(const MoveEdit& edit) {
  std::vector<Vector3> points;
  if (edit.jump) points.push_back(edit.jump->end_mm);
  for (const Via& via : edit.inserted) points.push_back(via.end_mm);
  points.push_back(edit.end_mm);
  return points;
}

/// Distance from `from` to the next point of the list that does not round to it; infinite without one.
template <typename Points>
double distance_to_next(const Vector3& from, const Points& points) {
  constexpr double equal_mm = 0.002;
  for (const Vector3& point : points)
    if (const double distance_mm = (point - from).norm(); distance_mm > equal_mm) return distance_mm;
  return std::numeric_limits<double>::infinity();
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
  if (numbers.is_copy) limit_zone(text, *call, numbers.spacing_mm.value_or(HUGE_VAL), changes);
}

void UrWriter::finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                              std::vector<TextChange>& changes) const {
  change_named_targets(program, edits, changes);
  shrink_zones(program, edits, changes);
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
    const auto call = move.words[0] ? ur_call_in_line(text, move.block.begin) : std::nullopt;
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

double UrWriter::zone_mm(std::string_view text, const UrCall& call) const {
  const UrArgument* argument = ur_argument(text, call, "r");
  return argument ? ur_length_mm * ur_constant(text, names_, argument->value).value_or(0) : 0;
}

void UrWriter::limit_zone(std::string_view text, const UrCall& call, double limit_mm,
                          std::vector<TextChange>& changes) const {
  constexpr int decimals = resolution_decimals(LengthUnit::metres);
  const UrArgument* argument = ur_argument(text, call, "r");
  if (argument == nullptr || zone_mm(text, call) <= limit_mm / 2) return;
  // Rounded down, and less than half: the zones at both ends do not overlap.
  constexpr double share = 0.49;
  const double steps = std::floor(share * limit_mm / ur_length_mm * power_of_ten(decimals));
  const double radius = steps / power_of_ten(decimals);
  const bool plain = ur_number(text, argument->value).has_value();
  changes.push_back({argument->value, plain ? number_text(text, argument->value, radius, decimals)
                                            : inserted_number(radius, decimals)});
}

/// A move is skipped by the control if the zones at its ends overlap. Beside an inserted point a zone is at
/// most half the distance to it. Zones that touch in the original still do not overlap.
void UrWriter::shrink_zones(const Program& program, const std::vector<MoveEdit>& edits,
                            std::vector<TextChange>& changes) const {
  const std::string_view text = program.text;
  std::map<std::size_t, double> limits_mm;  // of moves
  const auto limit = [&](std::size_t move, double distance_mm) {
    const auto [at, is_new] = limits_mm.try_emplace(move, distance_mm);
    if (!is_new) at->second = std::min(at->second, distance_mm);
  };
  const auto zone_at_end = [&](const Move& move) {
    const auto call = ur_call_in_line(text, move.block.begin);
    return call ? zone_mm(text, *call) : 0;
  };
  for (std::size_t m = 1; m < program.moves.size(); ++m) {
    const Move &move = program.moves[m], &before = program.moves[m - 1];
    if (!all_known(move.known_start) || !all_known(move.known_end) || !all_known(before.known_end)) continue;
    const MoveEdit *edit = edit_of(edits, m), *edit_before = edit_of(edits, m - 1);
    if (edit == nullptr && edit_before == nullptr) continue;
    const Vector3 from = edit_before ? edit_before->end_mm : before.end_mm;
    const std::vector<Vector3> points = edit ? points_of(*edit) : std::vector<Vector3>{move.end_mm};
    const double first_mm = distance_to_next(from, points);
    if (points.size() > 1) {
      std::vector<Vector3> back(points.rbegin() + 1, points.rend());
      back.push_back(from);
      limit(m - 1, first_mm);
      limit(m, distance_to_next(points.back(), back));
      continue;
    }
    const double both_mm = zone_at_end(before) + zone_at_end(move);
    if (both_mm <= first_mm || both_mm > (move.end_mm - move.start_mm).norm()) continue;
    limit(m - 1, first_mm);
    limit(m, first_mm);
  }
  for (const auto& [move, limit_mm] : limits_mm)
    if (const auto call = ur_call_in_line(text, program.moves[move].block.begin))
      limit_zone(text, *call, limit_mm, changes);
}

}  // namespace counterflex
