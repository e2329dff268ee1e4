#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/robot/kuka/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// A target of a statement: an aggregate, a name, or an expression.
struct Operand {
  Span span;
  std::optional<KrlAggregate> aggregate{};
  bool expression = false;  ///< the geometric operator ':' or other text
};

/// The operands and words of a motion statement.
struct MotionStatement {
  std::vector<Operand> operands;
  std::vector<std::string> words;  ///< "C_DIS", "#BASE", in upper case
};

Operand operand_at(std::string_view text, std::size_t at, std::size_t end) {
  Operand operand;
  operand.aggregate = aggregate_at(text, at, end);
  operand.span = operand.aggregate ? operand.aggregate->span : variable_at(text, at, end);
  const std::size_t next = behind_blanks(text, operand.span.end, end);
  operand.expression = operand.span.begin == operand.span.end || (next < end && text[next] == ':');
  if (operand.expression) operand.span.end = end;
  return operand;
}

MotionStatement motion_statement(std::string_view text, std::size_t at, std::size_t end) {
  MotionStatement statement;
  for (;;) {
    at = behind_blanks(text, at, end);
    statement.operands.push_back(operand_at(text, at, end));
    at = behind_blanks(text, statement.operands.back().span.end, end);
    if (at >= end || text[at] != ',') break;
    ++at;
  }
  while (at < end) {
    const std::size_t stop = std::min(text.find_first_of(" \t,", at), end);
    if (stop > at) statement.words.push_back(krl_word(text.substr(at, stop - at)));
    at = stop + 1;
  }
  return statement;
}

bool has_word(const MotionStatement& statement, std::string_view word) {
  return std::find(statement.words.begin(), statement.words.end(), word) != statement.words.end();
}

TargetMove with_zone(const KrlReading& r, const MotionStatement& statement, TargetMove how) {
  how.stays_whole = r.has_trigger;
  for (const std::string& word : statement.words) how = with_krl_zone(r, word, how);
  return how;
}

/// Whether a component is A1 to A6.
bool has_joint(const KrlAggregate& aggregate) {
  return std::any_of(aggregate.components.begin(), aggregate.components.end(), [](const KrlComponent& c) {
    return c.name.size() == 2 && c.name[0] == 'A' && c.name[1] >= '1' && c.name[1] <= '6';
  });
}

/// n - 1 of En, an external axis.
std::optional<std::size_t> external_axis(std::string_view name) {
  if (name.size() != 2 || name[0] != 'E' || name[1] < '1' || name[1] > '6') return std::nullopt;
  return static_cast<std::size_t>(name[1] - '1');
}

using ExternalValues = std::array<std::optional<double>, 6>;

/// An axis that the aggregate does not have stays as `before`.
ExternalValues external_of(const KrlAggregate& aggregate, ExternalValues before = {}) {
  for (const KrlComponent& component : aggregate.components)
    if (const auto axis = external_axis(component.name))
      before[*axis] = component.number ? std::optional(component.number->value) : std::nullopt;
  return before;
}

/// The place of an aggregate that gives A1 to A6 and no other axis of the robot.
std::optional<JointPlace> joints_of(const KrlAggregate& aggregate) {
  JointPlace place{.external = external_of(aggregate)};
  for (std::size_t i = 0; i < place.joints.size(); ++i) {
    const KrlComponent* axis = find_component(aggregate, fmt::format("A{}", i + 1));
    if (axis == nullptr || !axis->number) return std::nullopt;
    place.joints[i] = axis->number->value * deg;
  }
  return place;
}

/// Whether an index of "P[n]" is not a plain number.
bool has_variable_index(std::string_view variable) {
  const std::size_t open = variable.find('['), close = variable.find(']');
  return open != std::string_view::npos && !whole_number(variable, {open + 1, std::max(close, open + 1)});
}

/// The aggregate of an operand, its own or that of its name. Refuses the name of a target that is not in the
/// text.
std::optional<KrlAggregate> aggregate_of(const KrlReading& r, const RobotLine& line, std::string_view head,
                                         const Operand& operand) {
  if (operand.expression) return std::nullopt;
  if (operand.aggregate) return operand.aggregate;
  const RobotReading& robot = r.robot;
  const std::string_view name = part(robot.program.text, operand.span);
  if (auto aggregate = named_aggregate(r, krl_word(name))) return aggregate;
  if (in_body(r) && has_variable_index(name)) return std::nullopt;
  if (const auto changed = computed_in(r, krl_word(name)))
    throw InputError(
        ErrorKind::program_text, {robot.program.file, *changed, 1},
        fmt::format("the target '{}' of {} in line {} is computed at run time; write its numbers "
                    "into the statement: {} {{X 1, Y 2, Z 3, A 0, B 0, C 0}}",
                    name, head, line.line, head));
  refuse(robot.program.file, line, operand.span.begin,
         fmt::format("the target '{}' of {} is neither in this file nor in a data list; give the list that "
                     "has it with --data FILE.dat",
                     name, head));
}

/// Refuses a motion whose tool is not known.
void need_tool(const KrlReading& r, const RobotLine& line) {
  if (r.lost_tool == 0) return;
  refuse(r.robot.program.file, line, line.code.begin,
         fmt::format("the tool of this motion is not known: line {} selects it in a loop, a condition or a "
                     "routine, or its data are computed; select it in front of this motion",
                     r.lost_tool));
}

constexpr std::string_view run_time = "the target is computed at run time";
constexpr std::string_view in_a_body = "a loop or a condition may run the statement never or several times";

/// The aggregate of PTP; empty if it is computed or not in the text, as the home position.
std::optional<KrlAggregate> aggregate_of_ptp(const KrlReading& r, const Operand& operand) {
  if (operand.expression) return std::nullopt;
  if (operand.aggregate) return operand.aggregate;
  return named_aggregate(r, krl_word(part(r.robot.program.text, operand.span)));
}

/// PTP to a Cartesian target is a rapid. Its path between the targets is not known.
void read_ptp(KrlReading& r, const RobotLine& line, std::string_view head, const MotionStatement& statement) {
  const auto aggregate = aggregate_of_ptp(r, statement.operands.front());
  std::string why;
  if (!aggregate)
    why = "the target of PTP is computed at run time or is not in this file";
  else if (head == "PTP_REL")
    why = "PTP_REL is not followed";
  else if (has_joint(*aggregate))
    why = "PTP moves to joint positions";
  const auto target = aggregate ? krl_target(*aggregate) : std::nullopt;
  if (why.empty() && !target) why = run_time;
  if (in_body(r)) why = in_a_body;
  const bool states_turns = aggregate && find_component(*aggregate, "T") != nullptr;
  if (why.empty()) {
    need_tool(r, line);
    return add_target_move(
        r.robot, line, *target,
        with_zone(r, statement,
                  {.motion = Motion::rapid,
                   .stated_turns = states_turns ? StatedTurns::signs : StatedTurns::none}));
  }
  const bool is_sure = aggregate && head == "PTP" && !in_body(r);
  // A routine that was called may have changed a named target.
  const bool is_known = is_sure && (statement.operands.front().aggregate || !r.has_called);
  const bool stops = is_known && !with_zone(r, statement, {.motion = Motion::rapid}).passes;
  const auto before = r.robot.state.external;
  add_joint_move(r.robot, line, std::move(why), stops ? joints_of(*aggregate) : std::nullopt);
  if (is_known) r.robot.state.external = external_of(*aggregate, before);
}

/// The orientation and the external axes of a relative target; a zero changes nothing.
bool turns(RobotTarget& target) {
  bool turns = false;
  for (auto& number : target.orientation) {
    turns = turns || (number && number->value != 0);
    number.reset();
  }
  for (auto& number : target.external) {
    turns = turns || (number && *number != 0);
    number.reset();
  }
  return turns;
}

void read_line(KrlReading& r, const RobotLine& line, std::string_view head,
               const MotionStatement& statement) {
  const bool relative = head == "LIN_REL";
  const auto aggregate = aggregate_of(r, line, head, statement.operands.front());
  std::optional<RobotTarget> target = aggregate ? krl_target(*aggregate) : std::nullopt;
  std::string why = r.why_not_followed;
  if (!target) why = run_time;
  if (target && relative && (turns(*target) || has_word(statement, "#TOOL")))
    why = "LIN_REL turns the tool or moves along its axes";
  if (in_body(r)) why = in_a_body;
  if (!why.empty()) return add_unfollowed_move(r.robot, line, why);
  need_tool(r, line);
  add_target_move(r.robot, line, *target, with_zone(r, statement, {.relative = relative}));
}

bool ends_at_angle(std::string_view text, const MotionStatement& statement) {
  return std::ranges::any_of(
      statement.operands, [&](const Operand& operand) { return krl_word(part(text, operand.span)) == "CA"; });
}

void read_circle(KrlReading& r, const RobotLine& line, const MotionStatement& statement) {
  const std::string_view text = r.robot.program.text;
  if (statement.operands.size() < 2)
    refuse(r.robot.program.file, line, line.code.begin,
           "CIRC has no end point: write CIRC {X 1, ...}, {X 2, ...}");
  std::array<std::optional<RobotTarget>, 2> targets;  // auxiliary point, end
  for (std::size_t i = 0; i < 2; ++i)
    if (const auto aggregate = aggregate_of(r, line, "CIRC", statement.operands[i]))
      targets[i] = krl_target(*aggregate);
  std::string why = r.why_not_followed;
  if (!targets[0] || !targets[1]) why = run_time;
  if (!statement.operands[0].aggregate || !statement.operands[1].aggregate)
    why = "the points of CIRC are given by names";
  if (!r.why_no_circles.empty()) why = r.why_no_circles;
  if (in_body(r)) why = in_a_body;
  if (!why.empty()) return add_unfollowed_move(r.robot, line, why);
  if (ends_at_angle(text, statement))
    return add_unfollowed_move(r.robot, line,
                               "CIRC ends at an angle (CA), not at its end point; write CIRC without CA, two "
                               "for a full circle");
  constexpr std::string_view unknown_circle =
      "the circle of CIRC is not known: its start is not, or a number of its points is missing, or they lie "
      "on "
      "a line";
  need_tool(r, line);
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  if (!all_known(move.known_start)) return add_unfollowed_move(r.robot, line, std::string(unknown_circle));
  end_at_target(r.robot, *targets[1], with_zone(r, statement, {}), move);
  if (!go_through(*targets[0], move)) return add_unfollowed_move(r.robot, line, std::string(unknown_circle));
  r.robot.program.moves.push_back(std::move(move));
}

}  // namespace

TargetMove with_krl_zone(const KrlReading& r, std::string_view words, TargetMove how) {
  const std::string upper_case = krl_word(words);
  const bool by_length = upper_case.ends_with("C_DIS");
  if (by_length) how.zone.length_mm = r.zone_mm;
  how.passes = how.passes || by_length || upper_case.ends_with("C_VEL") || upper_case.ends_with("C_ORI") ||
               (how.motion == Motion::rapid && upper_case.ends_with("C_PTP"));
  return how;
}

std::optional<RobotTarget> krl_target(const KrlAggregate& aggregate) {
  constexpr std::string_view axes = "XYZ", angles = "CBA";  // about X, Y, Z
  RobotTarget target;
  for (const KrlComponent& component : aggregate.components) {
    const std::string_view name = component.name;
    const std::size_t axis = name.size() == 1 ? axes.find(name[0]) : std::string_view::npos;
    const std::size_t angle = name.size() == 1 ? angles.find(name[0]) : std::string_view::npos;
    const auto external = external_axis(name);
    if (name == "S" || name == "T") continue;
    if (!component.number) return std::nullopt;
    if (axis != std::string_view::npos)
      target.position[axis] = component.number;
    else if (angle != std::string_view::npos)
      target.orientation[angle] = component.number;
    else if (external)
      target.external[*external] = component.number->value;
    else
      return std::nullopt;
  }
  return target;
}

void read_krl_motion(KrlReading& r, const RobotLine& line, std::string_view head, std::size_t at) {
  const MotionStatement statement = motion_statement(r.robot.program.text, at, line.code.end);
  if (head == "PTP" || head == "PTP_REL") return read_ptp(r, line, head, statement);
  if (head == "LIN" || head == "LIN_REL") return read_line(r, line, head, statement);
  if (head == "CIRC") return read_circle(r, line, statement);
  add_unfollowed_move(r.robot, line, fmt::format("{} is not supported", head));
}

}  // namespace counterflex
