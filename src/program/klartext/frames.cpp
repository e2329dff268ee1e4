// Shifts (CYCL DEF 7) and rotations about Z (CYCL DEF 10) of the coordinates, presets and TRANS.
#include "program/gcode/frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/dialect.hpp"
#include "program/gcode/remarks.hpp"
#include "program/klartext/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view shifted_axes = "XYZABCUVW";
constexpr int basic_rotation = 143;                    // number of its displacement
constexpr int trans_datum = 1007, trans_other = 1008;  // numbers of displacements, no cycles

/// Converts a known position after a shift of the coordinates. After a rotation X and Y are unknown.
void enter_frame(KlartextReading& r) {
  KlartextState& state = r.state;
  const ProgramFrame before = r.program.frames[state.frame],
                     now{before.work_offset, state.shift_mm, state.turn_rad};
  if (before == now) return;
  state.frame = index_of_frame(r.program, now);
  state.position_mm = position_in(now, before, state.position_mm);
  if (before.turn_rad != now.turn_rad) state.known[0] = state.known[1] = false;
  state.pole.reset();
  state.contour = state.after_contour = false;
  state.run_begin = r.program.moves.size();
}

/// Whether no displacement acts but that of cycle 10, which a plain number ends.
bool may_turn(const KlartextReading& r) {
  const auto& displaced = r.state.displacements;
  return displaced.size() == displaced.count(10);
}

bool is_turned(const KlartextState& state) {
  return state.turn_rad != 0 || state.displacements.contains(10);
}

/// TRANS DATUM RESET ends each shift.
void end_shift(const KlartextBlock& block, KlartextReading& r) {
  KlartextState& state = r.state;
  const bool shifted = !state.shift_mm.isZero(0) || state.displacements.contains(7) ||
                       state.displacements.contains(trans_datum);
  if (shifted && (is_turned(state) || may_not_run(block, r)))
    return set_displacement(r, trans_datum, true,
                            "TRANS DATUM RESET in turned coordinates, or not always run");
  state.unfollowed_shift.fill(false);
  state.shift_mm.setZero();
  for (const int number : {7, trans_datum}) set_displacement(r, number, false, "");
  enter_frame(r);
}

void select_preset(const KlartextBlock& block, KlartextReading& r, std::string preset) {
  if (may_not_run(block, r))
    return set_displacement(r, 247, true, "a preset is selected in a block that a jump or '/' may skip");
  if (preset.starts_with('+')) preset.erase(0, 1);
  r.state.basic_rotation_deleted = false;
  end_frame(r);
  // A preset ends the shift, the mirror image, the rotation and the scales, but not the tilt (cycle 19,
  // PLANE). From M143 on the same preset has no basic rotation.
  r.state.unfollowed_shift.fill(false);
  for (const int number : {7, 8, 10, 11, 26, trans_datum, trans_other}) r.state.displacements.erase(number);
  r.state.known.fill(false);
  r.state.run_begin = r.program.moves.size();
  if (r.state.preset.empty()) {
    r.state.preset = preset;
    add_remark(r.program, line_of_file(r.program.expansion, block.line),
               fmt::format("{} selects preset {}", block.head == "PRESET" ? "PRESET SELECT" : "CYCL DEF 247",
                           preset));
    return set_displacement(r, 247, false, "");
  }
  set_displacement(r, 247, preset != r.state.preset || preset == "?", "another preset is selected");
}

}  // namespace

void set_displacement(KlartextReading& r, int number, bool acts, const char* why) {
  const bool acted = r.state.displacements.contains(number);
  if (acts) r.state.displacements[number] = why;
  if (!acts) r.state.displacements.erase(number);
  if (acts || acted) r.state.known.fill(false), r.state.run_begin = r.program.moves.size();
}

void shift_datum(const KlartextBlock& block, bool lexed, KlartextReading& r) {
  KlartextState& state = r.state;
  const bool unsure = may_not_run(block, r);
  const double unit = mm_per(state.unit.value_or(LengthUnit::millimetres));
  const Vector3 before = state.shift_mm;
  for (const KlartextWord& word : r.words) {
    const std::size_t axis = shifted_axes.find(word.key);
    if (axis == std::string_view::npos) continue;
    bool& unfollowed = state.unfollowed_shift[axis];
    if (!word.literal || unsure || (axis > 2 && word.value != 0)) {
      unfollowed = true;
    } else if (axis > 2 || !word.incremental) {
      unfollowed = unfollowed && word.incremental;
    }
    if (axis > 2 || unfollowed) continue;
    double& shift = state.shift_mm[static_cast<Eigen::Index>(axis)];
    shift = word.value * unit + (word.incremental ? shift : 0);
  }
  // "#5" of a datum table shifts all axes.
  if (!lexed) std::fill_n(state.unfollowed_shift.begin(), 3, true);
  // A second equal shift does not make the first one known.
  const bool shifts_turned =
      is_turned(state) && (state.shift_mm != before || state.displacements.contains(7));
  const auto& unfollowed = state.unfollowed_shift;
  const bool acts =
      shifts_turned || std::any_of(unfollowed.begin(), unfollowed.end(), [](bool on) { return on; });
  set_displacement(r, 7, acts,
                   shifts_turned
                       ? "CYCL DEF 7 shifts coordinates that CYCL DEF 10 has turned; shift them before"
                       : "CYCL DEF 7 shifts coordinates by more than plain numbers of X, Y and Z");
  enter_frame(r);
}

void turn_frame(const KlartextBlock& block, std::string_view rest, KlartextReading& r) {
  const bool incremental = rest.starts_with("IROT");
  const std::size_t begin = rest.find("ROT");
  std::string number(begin == std::string_view::npos ? rest : rest.substr(begin + 3));
  std::replace(number.begin(), number.end(), ',', '.');
  if (number.starts_with('+')) number.erase(0, 1);
  const std::optional<double> angle = read_number(number);
  if (angle == 0.0 && !is_turned(r.state)) return;
  const bool stated = angle && !may_not_run(block, r) && !(incremental && r.state.displacements.contains(10));
  const bool followed = stated && ((r.state.tool_along_z && may_turn(r)) || (angle == 0.0 && !incremental));
  if (!followed) {
    set_displacement(r, 10, true,
                     may_not_run(block, r)
                         ? "coordinates are turned in a block that a jump or '/' may skip"
                         : "CYCL DEF 10 turns coordinates by more than a plain number about Z");
    return;
  }
  set_displacement(r, 10, false, "");
  r.state.turn_rad = *angle * deg + (incremental ? r.state.turn_rad : 0);
  enter_frame(r);
}

void end_frame(KlartextReading& r) {
  r.state.shift_mm.setZero();
  r.state.turn_rad = 0;
  enter_frame(r);
}

void read_transformation(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  const bool datum = rest.starts_with("DATUM"), resets = rest.ends_with("RESET");
  if (datum && resets) return end_shift(block, r);
  if (datum) return set_displacement(r, trans_datum, true, "TRANS DATUM shifts coordinates");
  // Another reset changes nothing, or leaves coordinates unknown that are unknown.
  if (resets && !(rest.starts_with("ROTATION") && r.state.turn_rad != 0)) return;
  set_displacement(r, trans_other, true, "TRANS mirrors, rotates or scales coordinates");
}

void define_preset(const KlartextBlock& block, KlartextReading& r) {
  std::string definition;
  for (const Span& line : block.parts) definition += squeezed(part(r.program.text, line));
  const std::size_t q = definition.find("Q339=");
  select_preset(block, r, q == std::string::npos ? "?" : definition.substr(q + 5));
}

void read_preset(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  constexpr std::string_view select = "SELECT#";
  const bool plain = rest.starts_with(select) && block.parts.size() == 1 &&
                     rest.find_first_not_of("0123456789", select.size()) == std::string::npos;
  if (plain) return select_preset(block, r, rest.substr(select.size()));
  set_displacement(r, 247, true, "PRESET changes the preset by more than SELECT and a number");
}

void delete_basic_rotation(const KlartextBlock& block, KlartextReading& r) {
  KlartextState& state = r.state;
  if (state.basic_rotation_deleted) return;
  if (r.moves_read > 0 || may_not_run(block, r))
    return set_displacement(r, basic_rotation, true,
                            "M143 deletes the basic rotation behind the first move: coordinates are unknown");
  state.basic_rotation_deleted = true;
  add_remark(r.program, line_of_file(r.program.expansion, block.line),
             "M143 deletes the basic rotation: assumed of the work offset in the machine file, too");
}

}  // namespace counterflex
