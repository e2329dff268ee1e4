#include "program/robot/apt/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Statements that do not move the tool.
constexpr auto apt_motionless = std::to_array<std::string_view>({"PARTNO",
                                                                 "PPRINT",
                                                                 "REMARK",
                                                                 "TITLES",
                                                                 "MACHIN",
                                                                 "CUTTER",
                                                                 "SELECT",
                                                                 "COOLNT",
                                                                 "PAINT",
                                                                 "TLDATA",
                                                                 "MULTAX",
                                                                 "INTOL",
                                                                 "OUTTOL",
                                                                 "TOLER",
                                                                 "THICK",
                                                                 "CLPRNT",
                                                                 "NOPOST",
                                                                 "STOP",
                                                                 "OPSTOP",
                                                                 "DELAY",
                                                                 "DWELL",
                                                                 "TRNTYP",
                                                                 "SEQNO",
                                                                 "AUXFUN",
                                                                 "DISPLAY",
                                                                 "CLEARP",
                                                                 "TMARK",
                                                                 "TOOLNO",
                                                                 "TPRINT",
                                                                 "HEAD",
                                                                 "ARCSLP",
                                                                 "CLAMP",
                                                                 "LINTOL",
                                                                 "VERIFY",
                                                                 "PARTN0",
                                                                 "TOOLPATH",
                                                                 "END-OF-PATH",
                                                                 "LETTER",
                                                                 "ENDPTH",
                                                                 "CSI_SET_FLUTE_LENGTH",
                                                                 "CSI_SET_EXTENSION_LENGTH",
                                                                 "INDIRV",
                                                                 "INDIRP",
                                                                 "PROBE_DATA"});
/// Statements after which the points are other places.
constexpr auto apt_transforming = std::to_array<std::string_view>(
    {"TRACUT", "COPY", "TRANS", "ROTATE", "MIRROR", "INDEX", "ROTABL", "ROTHED", "REFSYS"});
constexpr auto apt_flow =
    std::to_array<std::string_view>({"MACRO", "CALL", "LOOPST", "LOOPND", "JUMPTO", "IF", "DO", "TERMAC"});

std::optional<double> plain(const AptReading& r, Span parameter) {
  const auto number = apt_number(r.robot.program.text, parameter);
  return number ? std::optional(number->value) : std::nullopt;
}

/// The first number among the parameters; empty without one.
std::optional<double> first_number(const AptReading& r, const AptStatement& statement) {
  for (const Span parameter : statement.parameters)
    if (const auto number = plain(r, parameter)) return number;
  return std::nullopt;
}

bool has_word(const AptReading& r, const AptStatement& statement, std::span<const std::string_view> words) {
  return std::ranges::any_of(statement.parameters, [&](Span parameter) {
    return is_among(apt_word(part(r.robot.program.text, parameter)), words);
  });
}

void read_unit(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  constexpr auto millimetres = std::to_array<std::string_view>({"MM", "MILLIMETER", "MILLIMETERS"});
  constexpr auto inches = std::to_array<std::string_view>({"IN", "INCH", "INCHES"});
  const bool metric = has_word(r, statement, millimetres);
  if (!metric && !has_word(r, statement, inches))
    refuse(r.robot.program.file, line, line.code.begin,
           fmt::format("{}/ has an unknown unit; use MM or INCHES", statement.head));
  const LengthUnit unit = metric ? LengthUnit::millimetres : LengthUnit::inches;
  if (r.unit && *r.unit != unit) forget_position(r.robot);
  r.unit = unit;
}

void set_feed(AptReading& r) {
  RobotState& state = r.robot.state;
  if (r.feed_per_turn_mm) state.feed_mm_min = *r.feed_per_turn_mm * state.spindle_rpm;
}

/// Whether each parameter is a plain number or one of `words`.
bool has_only(const AptReading& r, const AptStatement& statement, std::span<const std::string_view> words) {
  return std::ranges::all_of(statement.parameters, [&](Span parameter) {
    return plain(r, parameter) || is_among(apt_word(part(r.robot.program.text, parameter)), words);
  });
}

/// FEDRAT/250, FEDRAT/250,MMPM, FEDRAT/IPM,10, FEDRAT/0.1,MMPR: without a unit it is per minute. With another
/// word it is unknown.
void read_feed(AptReading& r, const AptStatement& statement) {
  constexpr auto per_turn = std::to_array<std::string_view>({"MMPR", "IPR", "PERREV"});
  constexpr auto metric = std::to_array<std::string_view>({"MMPM", "MMPR"});
  constexpr auto inch_units = std::to_array<std::string_view>({"IPM", "IPR"});
  constexpr auto units = std::to_array<std::string_view>({"MMPM", "MMPR", "IPM", "IPR", "PERMIN", "PERREV"});
  const double program_mm = mm_per(r.unit.value_or(LengthUnit::millimetres));
  const double unit_mm = has_word(r, statement, metric)       ? 1
                         : has_word(r, statement, inch_units) ? mm_per(LengthUnit::inches)
                                                              : program_mm;
  const auto number = first_number(r, statement);
  const bool is_known = number && *number > 0 && has_only(r, statement, units) && !r.may_skip;
  r.feed_per_turn_mm.reset();
  r.robot.state.feed_mm_min = is_known ? *number * unit_mm : 0;
  if (is_known && has_word(r, statement, per_turn)) r.feed_per_turn_mm = *number * unit_mm;
  set_feed(r);
}

/// SPINDL/2000,CLW, SPINDL/RPM,2000,CLW: the first number, if no other word is before it. SPINDL/ON and
/// SPINDL/CLW keep the speed. Others leave it unknown.
void read_spindle(AptReading& r, const AptStatement& statement) {
  constexpr auto of_surface = std::to_array<std::string_view>({"SFM", "SMM", "OFF", "ORIENT", "LOCK"});
  constexpr auto starting = std::to_array<std::string_view>({"ON", "RPM", "CLW", "CCLW"});
  double& speed = r.robot.state.spindle_rpm;
  const auto& parameters = statement.parameters;
  const auto first = std::ranges::find_if(parameters, [&](Span parameter) {
    return !is_among(apt_word(part(r.robot.program.text, parameter)), starting);
  });
  if (has_word(r, statement, of_surface) || r.may_skip)
    speed = 0;
  else if (first != parameters.end())
    speed = plain(r, *first).value_or(0);
  set_feed(r);
}

/// A tool that the control may not change to is unknown.
void select_tool(AptReading& r, const AptStatement& statement) {
  const double number = first_number(r, statement).value_or(0);
  const bool is_number = number >= 0 && number == static_cast<std::int32_t>(std::min(number, 1e9));
  enter_robot_tool(r.robot, is_number && !r.may_skip ? static_cast<std::int32_t>(number) : 0);
}

/// Another tool offset, or the end of the program in the control: a post may move the axes there.
void lose_position(AptReading& r) {
  forget_position(r.robot);
  r.robot.state.moved_by_machine = true;
}

/// The name by which the machine file or --work places a coordinate system: CSYS_NAME for CSYS/NAME, else
/// CSYS_1, CSYS_2, ... by the order of their texts.
std::string system_name(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  const std::string_view text = r.robot.program.text;
  if (statement.parameters.size() == 1) {
    const std::string name = apt_word(part(text, statement.parameters[0]));
    if (!name.empty() && is_letter(name[0]) && std::ranges::all_of(name, is_identifier_character))
      return "CSYS_" + name;
  }
  const std::string system = apt_word(part(text, line.code));
  const auto known = std::ranges::find(r.systems, system);
  const auto number = known - r.systems.begin() + 1;
  if (known == r.systems.end()) r.systems.push_back(system);
  return fmt::format("CSYS_{}", number);
}

/// CSYS/ and MSYS/ state the coordinate system of the points after them: rows of a matrix with its origin, or
/// the origin and two axes. Each other text is another system.
void select_system(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  constexpr auto same = std::to_array<double>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  constexpr auto same_axes = std::to_array<double>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::vector<double> numbers;
  for (const Span parameter : statement.parameters) numbers.push_back(plain(r, parameter).value_or(2));
  const bool is_same = std::ranges::equal(numbers, same) || std::ranges::equal(numbers, same_axes);
  ProgramFrame frame = r.robot.program.frames[r.robot.state.frame];
  frame.work_offset = is_same ? "" : system_name(r, line, statement);
  enter_robot_frame(r.robot, frame);
}

/// TLAXIS/i,j,k is the axis at the points of three numbers behind it. Beside points that have an axis of
/// their own it is not used: the axis and the place are unknown until the next such point.
void read_tool_axis(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  if (r.robot.turns) return lose_position(r);
  Vector3 axis = Vector3::Zero();
  bool is_plain = statement.parameters.size() == 3;
  for (Eigen::Index i = 0; is_plain && i < 3; ++i) {
    const auto number = plain(r, statement.parameters[static_cast<std::size_t>(i)]);
    is_plain = number.has_value();
    axis[i] = number.value_or(0);
  }
  if (!is_plain || axis.isZero(0))
    refuse(r.robot.program.file, line, line.code.begin,
           "TLAXIS/ is not an axis of three plain numbers; write TLAXIS/0,0,1, or post each point with its "
           "axis");
  ProgramFrame frame = r.robot.program.frames[r.robot.state.frame];
  frame.tool_axis = axis.stableNormalized();
  enter_robot_frame(r.robot, frame);
}

/// Of OPSKIP/, CYCLE/ and CUTCOM/.
bool is_switched_on(const AptReading& r, const AptStatement& statement) {
  return statement.parameters.empty() ||
         apt_word(part(r.robot.program.text, statement.parameters[0])) != "OFF";
}

bool reads_state(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  const std::string_view head = statement.head;
  if (head == "UNITS" || head == "UNIT")
    read_unit(r, line, statement);
  else if (head == "FEDRAT")
    read_feed(r, statement);
  else if (head == "RAPID")
    r.rapid = true;
  else if (head == "SPINDL")
    read_spindle(r, statement);
  else if (head == "LOADTL" || head == "LOAD" || head == "TLCHG" || head == "TURRET")
    select_tool(r, statement);
  else if (head == "CSYS" || head == "MSYS" || head == "ORIGIN")
    select_system(r, line, statement);
  else if (head == "OPSKIP")
    r.may_skip = is_switched_on(r, statement);
  else if (head == "TLAXIS")
    read_tool_axis(r, line, statement);
  else if (head == "CUTCOM")
    r.in_cutcom = is_switched_on(r, statement) || (r.may_skip && r.in_cutcom);
  else if (head == "CYCLE")
    r.in_cycle = is_switched_on(r, statement) || (r.may_skip && r.in_cycle);
  else if (head == "SWITCH" || head == "REWIND" || head == "END")
    lose_position(r);
  else
    return false;
  return true;
}

/// Whether the text of INSERT is not a block of any control: one comment in parentheses, or a text that
/// begins with a quantity, "5MM CRB 4FL", as posts write it into a comment.
bool inserts_no_block(std::string_view text, Span code) {
  Span inserted{code.begin + std::string_view("INSERT").size(), code.end};
  while (inserted.begin < inserted.end && (is_blank(text[inserted.begin]) || text[inserted.begin] == '/'))
    ++inserted.begin;
  const std::string_view words = part(text, inserted);
  const std::size_t behind_number = std::min(words.find_first_not_of("0123456789."), words.size());
  const bool is_quantity =
      behind_number > 0 && behind_number < words.size() && is_letter(words[behind_number]);
  return words.empty() || is_quantity || (words.starts_with('(') && words.find(')') == words.size() - 1);
}

}  // namespace

void read_apt_statement(AptReading& r, const RobotLine& line) {
  const AptStatement statement = apt_statement(r.robot.program.text, line.code);
  const std::string_view head = statement.head;
  if (head == "GOTO") return read_apt_point(r, line, statement);
  if (head == "FROM") return add_joint_move(r.robot, line, "FROM/ states where the tool is");
  if (head == "CIRCLE") return read_apt_circle(r, statement);
  if (head == "FINI") {
    r.robot.ended = true;
    return;
  }
  if (reads_state(r, line, statement) || is_among(head, apt_motionless)) return;
  // Texts need no '/': "PARTNO BRACKET".
  for (const std::string_view text : {"PARTNO", "PPRINT", "REMARK"})
    if (head.starts_with(text)) return;
  if (head.starts_with("INSERT")) {
    if (inserts_no_block(r.robot.program.text, line.code)) return;
    return add_unfollowed_move(r.robot, line,
                               "INSERT puts its text into the program of the machine: it may move the tool");
  }
  if (head == "GOHOME" || head == "HOME" || head == "RETRCT")
    return add_joint_move(r.robot, line, fmt::format("{} moves to a position of the machine", head));
  if (is_among(head, apt_transforming))
    refuse(
        r.robot.program.file, line, line.code.begin,
        fmt::format("{}/ changes the places of the points after it, which is not supported; post the points "
                    "as they are to be reached",
                    head));
  if (is_among(head, apt_flow))
    refuse(r.robot.program.file, line, line.code.begin,
           fmt::format("{}/ is not supported; write the statements in the order in which they run", head));
  add_unfollowed_move(r.robot, line, fmt::format("'{}' is not supported: it may move the tool", head));
}

}  // namespace counterflex
