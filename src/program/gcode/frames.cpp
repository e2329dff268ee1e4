#include "program/gcode/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/read_move.hpp"

namespace counterflex {
namespace {

Matrix3 turn_about_z(double angle) {
  return from_rpy({0, 0, angle});
}

/// Controls start with G54.
std::string name_of(const std::string& work_offset) {
  return work_offset.empty() ? "G54" : work_offset;
}

ProgramFrame frame_of(const Reading& r, const std::string& work_offset) {
  const FrameShifts& shifts = r.state.shifts;
  const Vector3& centre = shifts.turn_centre_mm;
  const auto found = r.offsets.find(name_of(work_offset));
  const SetOffset offset = found == r.offsets.end() ? SetOffset{} : found->second;
  const Vector3 origin =
      offset.moved_mm + shifts.set_mm + shifts.local_mm + centre - turn_about_z(shifts.turn_rad) * centre;
  return {work_offset, origin, shifts.turn_rad, offset.set_mm};
}

const ProgramFrame& current(const Reading& r) {
  return r.program.frames[r.state.frame];
}

/// Selects the frame again after the shifts of the active offset have changed.
void change_frame(Reading& r) {
  end_contour(r);
  r.state.cycle.initial.reset();
  enter_frame(r, current(r).work_offset);
}

const Word* axis_word(const Reading& r, std::size_t axis) {
  return r.sorted.word(letters_of_axes[axis]);
}

/// Whether the block runs exactly once, all states are known, and its words are plain numbers of X, Y, Z and
/// `more`. Zero needs no unit.
bool is_plain(const Block& block, const Reading& r, std::string_view more) {
  if (r.in_body() || r.state.displaced != 0 || r.state.unknown_modes != 0) return false;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    const Word* word = r.sorted.word(letter);
    if (word == nullptr || letter == 'N') continue;
    const bool used = (letter >= 'X' && letter <= 'Z') || more.find(letter) != std::string_view::npos;
    if (!used || !word->literal) return false;
    if (letter >= 'X' && letter <= 'Z' && word->value != 0) demand_unit(block, r, *word);
  }
  return true;
}

/// LinuxCNC and Mach3 store G52 and G92 in the same place.
bool has_one_shift(const Dialect& dialect) {
  return (dialect.family & (linuxcnc_family | mach3_family)) != 0;
}

bool shift_locally(const Block& block, Reading& r) {
  // G52 of LinuxCNC has the same effect under G91.
  const bool adds = r.state.relative && r.dialect.family != linuxcnc_family;
  if (!is_plain(block, r, "") || adds || r.state.shifts.turn_rad != 0) return false;
  Vector3& shift = has_one_shift(r.dialect) ? r.state.shifts.set_mm : r.state.shifts.local_mm;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const Word* word = axis_word(r, axis)) coordinate(shift, axis) = length_mm(r, *word);
  change_frame(r);
  return true;
}

/// G92 at a position that the tool has reached: its words are shifted by the correction at this place, so
/// that the coordinates do not change. The shift has the digits of all words that led to the position, and
/// zeros at the end are not written.
void add_set_position(const Block& block, Reading& r) {
  constexpr int digits_of_positions = 9;
  Move& move = start_move(block, r, Motion::rapid);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const Word* word = axis_word(r, axis))
      move.words[axis] = AxisWord{word->number, std::max(word->decimals, digits_of_positions)};
  move.relative = false;
  move.handling = Handling::held;
  move.end_mm = r.state.position_mm;
  move.known_end = r.state.known;
  move.may_insert_words = false;
}

/// Before the first move, G92 gives the position at which the operator has placed the tool.
bool begins(const Reading& r) {
  const auto& taken = r.moved_by_machine;
  return r.program.moves.empty() && !r.program.before && !taken[0] && !taken[1] && !taken[2];
}

/// The words give the position of the tool: moves `zero_mm` so that they are right.
bool move_zero(const Block& block, Reading& r, Vector3& zero_mm) {
  if (r.state.shifts.turn_rad != 0) return false;
  const bool first = begins(r);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis_word(r, axis) != nullptr && !r.state.known[axis] && !first) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Word* word = axis_word(r, axis);
    if (word == nullptr) continue;
    const double value = length_mm(r, *word);
    if (r.state.known[axis])
      coordinate(zero_mm, axis) += coordinate(r.state.position_mm, axis) - value;
    else
      coordinate(r.state.position_mm, axis) = value, r.state.known[axis] = true;
  }
  change_frame(r);
  if (first)
    r.begin.takes_position = true;
  else
    add_set_position(block, r);
  return true;
}

/// G92. On shop controls it ends G52 of the axes that it names.
bool set_position_by_words(const Block& block, Reading& r) {
  FrameShifts& shifts = r.state.shifts;
  if (!move_zero(block, r, shifts.set_mm)) return false;
  for (std::size_t axis = 0; r.dialect.macro_words && axis < 3; ++axis)
    if (axis_word(r, axis) != nullptr)
      coordinate(shifts.set_mm, axis) += std::exchange(coordinate(shifts.local_mm, axis), 0.0);
  return true;
}

/// G92.1 of shop controls: the named axes have the coordinates of the work offset again, without G92 and G52.
bool preset(const Block& block, Reading& r) {
  FrameShifts& shifts = r.state.shifts;
  if (!is_plain(block, r, "")) r.state.known.fill(false);
  if (shifts.turn_rad != 0) r.state.displaced |= rotated;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis_word(r, axis) != nullptr)
      coordinate(shifts.set_mm, axis) = coordinate(shifts.local_mm, axis) = 0;
  change_frame(r);
  return true;
}

bool end_set_position(const Block& block, Reading& r) {
  if (!is_plain(block, r, "")) r.state.known.fill(false);
  r.state.shifts.set_mm.setZero();
  change_frame(r);
  return true;
}

/// G68 X Y R: counter-clockwise in the plane X Y.
bool turn(const Block& block, Reading& r) {
  const Word *x = r.sorted.word('X'), *y = r.sorted.word('Y'), *angle = r.sorted.word('R');
  const bool about_z = r.state.normal == 2 && !r.state.relative && r.sorted.word('Z') == nullptr;
  if (!is_plain(block, r, "R") || !about_z || x == nullptr || y == nullptr || angle == nullptr) return false;
  if (r.state.shifts.turn_rad != 0) return false;
  r.state.shifts.turn_centre_mm = {length_mm(r, *x), length_mm(r, *y), 0};
  r.state.shifts.turn_rad = angle->value * deg;
  change_frame(r);
  return true;
}

bool end_turn(Reading& r) {
  r.state.shifts.turn_rad = 0;
  r.state.shifts.turn_centre_mm.setZero();
  change_frame(r);
  return true;
}

double value_of(const Block& block, char letter) {
  for (const Word& word : block.words)
    if (word.letter == letter) return word.value;
  return 0;
}

/// Plain numbers only; ROT and AROT about Z only, RPL in the plane X Y.
bool is_plain_frame(const Block& block, const Reading& r, bool turns) {
  const auto displaced = static_cast<std::uint16_t>(r.state.displaced & ~framed);
  if (r.in_body() || displaced != 0 || r.state.unknown_modes != 0 || !r.state.unit ||
      !empty(block.block_delete))
    return false;
  for (const Word& word : block.words) {
    const bool known = std::string_view("NXYZR").find(word.letter) != std::string_view::npos;
    if (!known || !word.literal || word.mode != DistanceMode::modal) return false;
    if (word.letter == 'R' && (!turns || r.state.normal != 2)) return false;
  }
  return !turns || (value_of(block, 'X') == 0 && value_of(block, 'Y') == 0);
}

/// TRANS, ROT, SCALE or MIRROR alone in a block that runs exactly once: all frames end.
bool ends_frames(const Block& block, const Reading& r) {
  const bool adds = block.statement == Statement::added_shift || block.statement == Statement::added_turn;
  const auto is_number = [](const Word& word) { return word.letter == 'N'; };
  return block.statement_is_bare && !adds && !r.in_body() && empty(block.block_delete) &&
         std::all_of(block.words.begin(), block.words.end(), is_number);
}

/// Whether the words of the statement are followed.
bool is_followed_frame(const Block& block, const Reading& r, bool turns, bool adds) {
  return block.statement != Statement::frame && is_plain_frame(block, r, turns) &&
         (!adds || (r.state.displaced & framed) == 0);
}

}  // namespace

bool apply_frame_statement(const Block& block, Reading& r) {
  const Statement what = block.statement;
  const bool turns = what == Statement::turn || what == Statement::added_turn;
  const bool adds = what == Statement::added_shift || what == Statement::added_turn;
  const bool ends = ends_frames(block, r);
  if (!ends && !is_followed_frame(block, r, turns, adds)) return false;
  FrameShifts& shifts = r.state.shifts;
  if (!adds) shifts.local_mm.setZero(), shifts.turn_rad = 0;
  if (turns) {
    shifts.turn_rad += (value_of(block, 'Z') + value_of(block, 'R')) * deg;
  } else if (!ends) {
    const Vector3 words(value_of(block, 'X'), value_of(block, 'Y'), value_of(block, 'Z'));
    shifts.local_mm += turn_about_z(shifts.turn_rad) * words * mm_per(*r.state.unit);
  }
  if ((r.state.displaced & framed) != 0) {
    r.state.displaced = static_cast<std::uint16_t>(r.state.displaced & ~framed);
    r.state.known.fill(false);
  }
  change_frame(r);
  return true;
}

Pose in_offset(const ProgramFrame& frame) {
  return {turn_about_z(frame.turn_rad), frame.origin_mm};
}

std::size_t index_of_frame(Program& program, const ProgramFrame& frame) {
  const auto found = std::find(program.frames.begin(), program.frames.end(), frame);
  if (found != program.frames.end()) return static_cast<std::size_t>(found - program.frames.begin());
  program.frames.push_back(frame);
  return program.frames.size() - 1;
}

Vector3 position_in(const ProgramFrame& now, const ProgramFrame& before, const Vector3& p_mm) {
  return inverse(in_offset(now)) * (in_offset(before) * p_mm);
}

void enter_frame(Reading& r, const std::string& work_offset) {
  const ProgramFrame before = current(r), now = frame_of(r, work_offset);
  r.state.frame = index_of_frame(r.program, now);
  if (before == now) return;
  if (before.work_offset != now.work_offset) return r.state.known.fill(false);
  const Vector3 position_mm = position_in(now, before, r.state.position_mm);
  if (r.dialect.sinumerik_words) r.state.untravelled_mm += position_mm - r.state.position_mm;
  r.state.position_mm = position_mm;
  if (before.turn_rad != now.turn_rad) r.state.known[0] = r.state.known[1] = false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (before.set_mm[axis] != now.set_mm[axis]) r.state.known[axis] = false;
}

bool set_work_offset(const Block& block, Reading& r) {
  constexpr std::array<const char*, 9> names{"G54", "G55",   "G56",   "G57",  "G58",
                                             "G59", "G59.1", "G59.2", "G59.3"};
  const Word *l = r.sorted.word('L'), *p = r.sorted.word('P'), *turn = r.sorted.word('R');
  if (!is_plain(block, r, "LPR") || l == nullptr || p == nullptr || (turn != nullptr && turn->value != 0))
    return false;
  const bool extended = l->value == 20 && r.dialect.macro_words;  // Fanuc, Haas: L20 P3 is G54.1 P3
  // G10 of LinuxCNC and GRBL has the same effect under G91.
  const bool linuxcnc_or_grbl = (r.dialect.family & (linuxcnc_family | grbl_family)) != 0;
  const bool adds = r.state.relative && !linuxcnc_or_grbl;
  if (adds || !empty(block.block_delete) || p->value < 0 || p->value > (extended ? 300 : 9)) return false;
  const std::string acting = name_of(current(r).work_offset);
  const bool acts = p->value == 0 && linuxcnc_or_grbl;
  if (p->value == 0 && !acts) return false;  // Fanuc's shift of all offsets
  const std::string name = extended ? fmt::format("G54.1 P{}", count_of(*p))
                           : acts   ? acting
                                    : names[static_cast<std::size_t>(count_of(*p)) - 1];
  SetOffset& offset = r.offsets[name];
  if (l->value == 20 && !extended) return name == acting && move_zero(block, r, offset.moved_mm);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const Word* word = axis_word(r, axis)) {
      offset.set_mm[axis] = length_mm(r, *word);
      coordinate(offset.moved_mm, axis) = 0;
    }
  if (name == acting) change_frame(r);
  return true;
}

void end_local_shift(Reading& r) {
  FrameShifts& shifts = r.state.shifts;
  const bool turned = shifts.turn_rad != 0 && !(shifts.local_mm + shifts.set_mm).isZero(0);
  r.state.displaced &= static_cast<std::uint16_t>(~shifted);
  if (turned) r.state.displaced |= rotated;  // the centre of G68 may stay, or move
  shifts.local_mm.setZero();
  if (has_one_shift(r.dialect)) {
    shifts.set_mm.setZero();
    r.state.displaced &= static_cast<std::uint16_t>(~set_position);
  }
  r.state.known.fill(false);
  change_frame(r);
}

bool has_local_shift(const Reading& r) {
  const FrameShifts& shifts = r.state.shifts;
  return !shifts.local_mm.isZero(0) || (has_one_shift(r.dialect) && !shifts.set_mm.isZero(0));
}

bool apply_frame_code(const Block& block, Reading& r, const GCode& code) {
  switch (code.tenths) {
    case 520:
      return shift_locally(block, r);
    case 680:
      return turn(block, r);
    case 690:
      return r.state.shifts.turn_rad != 0 && end_turn(r);
    case 920:
      return is_plain(block, r, "") && set_position_by_words(block, r);
    case 921:
      if (r.dialect.macro_words && r.sorted.has_any("XYZ")) return preset(block, r);
      return !r.state.shifts.set_mm.isZero(0) && end_set_position(block, r);
    case 922:
      return !r.state.shifts.set_mm.isZero(0) && end_set_position(block, r);
    default:
      return false;
  }
}

}  // namespace counterflex
