#include "program/gcode/offsets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "program/evaluate/variables.hpp"
#include "program/gcode/frames.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/remarks.hpp"
#include "program/gcode/words/used_letters.hpp"

namespace counterflex {
namespace {

constexpr std::uint16_t other_offsets = 1u << 15;

const std::string& offset_that_acts(const Reading& r) {
  return r.program.frames[r.state.frame].work_offset;
}

/// The offset of "G59 P3" of Mach3, whose numbers from 1 to 6 are G54 to G59.
std::optional<std::string> fixture_name(const Block& block, const Reading& r, const FoundG& offset) {
  const Word& p = *r.sorted.word('P');
  if (!p.literal) return std::nullopt;
  if (offset.code->tenths != 590 || p.value < 1 || p.value > 6 || p.value != std::floor(p.value))
    refuse_word(block, r, p,
                fmt::format("G{} P{} selects a work offset that a machine file cannot name: use G54 to G59",
                            offset.word->value, p.value));
  return fmt::format("G{}", 53 + count_of(p));
}

/// Whether a code of the block besides its work offset uses P.
bool has_other_p(const Reading& r) {
  SortedBlock others = r.sorted;
  std::erase_if(others.g, [](const FoundG& g) { return g.code->action == Action::work_offset; });
  return (used_letters(others, r.dialect, Context::plain) & letter_bit('P')) != 0;
}

/// "G54", "G59.3", "G54.1 P3" (G154 P3 and G112 of Haas, G54 P3 of Fanuc).
std::optional<std::string> offset_name(const Block& block, const Reading& r, const FoundG& offset) {
  const Word* p = r.sorted.word('P');
  if (r.dialect.family == mach3_family && p != nullptr && !has_other_p(r))
    return fixture_name(block, r, offset);
  if (offset.code->tenths >= 1100 && offset.code->tenths <= 1290)
    return fmt::format("G54.1 P{}", offset.code->tenths / 10 - 109);
  const bool extended = offset.code->tenths == 541 || offset.code->tenths == 1540 ||
                        (offset.code->tenths == 540 && p != nullptr && r.dialect.macro_words &&
                         !r.sorted.has(MAction::call) && !r.sorted.has(Action::dwell));
  if (!extended) return fmt::format("G{}", offset.word->value);
  if (p == nullptr || !p->literal) return std::nullopt;
  return fmt::format("G54.1 P{}", p->value);
}

void add_displacement(const Block& block, Reading& r, std::uint16_t bit) {
  r.state.displaced |= bit;
  if (bit != modal_macro) r.state.known.fill(false);
  end_contour(r);
  note_uncorrected(block, r, why_not_followed(r));
}

/// The bit of an offset in ModalState::offsets_set.
std::uint16_t offset_bit(std::string_view name) {
  if (name.empty() || name == "G54") return 1;
  constexpr std::array<std::string_view, 8> names{"G55", "G56",   "G57",   "G58",
                                                  "G59", "G59.1", "G59.2", "G59.3"};
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? other_offsets : static_cast<std::uint16_t>(2u << (found - names.begin()));
}

void displace_by_data(Reading& r) {
  const bool set = (r.state.offsets_set & offset_bit(offset_that_acts(r))) != 0;
  const auto others = static_cast<std::uint16_t>(r.state.displaced & ~data);
  r.state.displaced = set ? static_cast<std::uint16_t>(others | data) : others;
}

/// The number of H that G43 uses, and its length if the options have it.
void find_length(const Reading& r, std::optional<double>& number, std::optional<double>& length_mm) {
  const Word* h = r.sorted.word('H');
  if (h != nullptr && !h->literal) return;
  if (h != nullptr) number = h->value;
  const long tool = h != nullptr ? count_of(*h) : r.state.tool;
  const auto found = r.options.tool_lengths_mm.find(tool);
  if (r.lengths_set || found == r.options.tool_lengths_mm.end()) return;
  if (h == nullptr) number = static_cast<double>(tool);
  length_mm = found->second;
}

bool is_zero_or_absent(const Word* word) {
  return word == nullptr || (word->literal && word->value == 0);
}

/// The axes of the block, A in the lowest bit.
Letters named_axes(const Reading& r) {
  Letters axes = 0;
  for (const char letter : std::string_view("ABCUVWXYZ"))
    if (r.sorted.word(letter) != nullptr) axes |= letter_bit(letter);
  return axes;
}

bool is_modal_macro(const GCode& code) {
  return code.tenths == 660 || code.tenths == 661;
}

/// G51.1 X0 adds X to the mirrored axes. A G66 under another one acts in addition to it.
void note_begin(Reading& r, const GCode& code) {
  if (code.bit == mirrored) r.state.mirrored_axes |= named_axes(r) != 0 ? named_axes(r) : ~Letters{0};
  if (is_modal_macro(code)) ++r.state.modal_macros;
}

/// Whether the code ends the displacement of its bit. G50.1 X0 ends the mirror image of X only, G67 the last
/// G66 only, G92.1 Z0 the position of Z only.
bool ends_displacement(Reading& r, const GCode& code) {
  ModalState& state = r.state;
  if (code.tenths == 670) return --state.modal_macros <= 0;
  if (code.bit == mirrored) {
    state.mirrored_axes &= named_axes(r) != 0 ? ~named_axes(r) : Letters{0};
    return state.mirrored_axes == 0;
  }
  return ends_all_axes(r, code);
}

/// G92 S2000 of shop controls: the highest speed of the spindle.
bool limits_speed(const Reading& r, const GCode& code) {
  return code.tenths == 920 && r.dialect.macro_words && r.sorted.word('S') != nullptr && named_axes(r) == 0;
}

void end_displacements(Reading& r) {
  for (const FoundG& g : r.sorted.g) {
    if (g.code->action != Action::end_displace || (r.state.displaced & g.code->bit) == 0) continue;
    if (!ends_displacement(r, *g.code)) continue;
    r.state.displaced &= static_cast<std::uint16_t>(~g.code->bit);
    r.state.known.fill(false);
  }
  if (r.sorted.has(Action::no_tool_length) && (r.state.displaced & tool_point) != 0) {
    r.state.displaced &= static_cast<std::uint16_t>(~tool_point);
    r.state.known.fill(false);
  }
}

bool sets_offset(const Word* l) {
  return l != nullptr && l->literal && (l->value == 2 || l->value == 20);
}

void lose_active_length(Reading& r) {
  r.state.tool_length.reset();
  r.state.tool_length_mm.reset();
}

void lose_tool_lengths(Reading& r) {
  lose_active_length(r);
  r.lengths_set = true;
}

/// The block may have set any offset and any tool length.
void lose_offsets(const Block& block, Reading& r, std::string_view why) {
  note_offset_set(r, {});
  lose_tool_lengths(r);
  note_uncorrected(block, r, why);
}

/// Whether the variable, an index or a name of digits, may be an offset or a tool length of the control.
bool may_be_offset(std::string_view variable, const Reading& r) {
  if (variable.starts_with("#<")) return false;
  const auto number = value_of_expression(variable.substr(1), r.dialect, r.variables).value;
  if (!number) return true;
  constexpr double last_of_linuxcnc = 5160, last_output = 1999, first_alarm = 3000, last_alarm = 3999;
  if (r.dialect.o_words) return *number > last_of_linuxcnc;
  return *number > last_output && (*number < first_alarm || *number > last_alarm);
}

/// G10 without L sets a tool offset of shop controls.
bool sets_tools(const Reading& r, const Word* l) {
  if (l == nullptr) return r.dialect.macro_words && r.sorted.word('R') != nullptr;
  return l->literal && (l->value == 1 || (l->value >= 10 && l->value <= 13));
}

/// Whether G10 may set the length of a tool. Shop controls have the radius in L12 and L13, others in R.
bool sets_tool_length(const Reading& r, const Word* l) {
  if (!r.dialect.macro_words) return r.sorted.word('Z') != nullptr;
  return l == nullptr || l->value < 12;
}

/// Whether G10 sets the length of the tool to `given_mm`: L10 of shop controls, L1 of others.
bool sets_same_length(const Reading& r, const Word* l, double given_mm) {
  constexpr double rounding_mm = 1e-6;
  const Word* length = r.sorted.word(r.dialect.macro_words ? 'R' : 'Z');
  const double direct = r.dialect.macro_words ? 10 : 1;
  return l != nullptr && l->value == direct && length != nullptr && length->literal && r.state.unit &&
         !r.state.relative && std::abs(length_mm(r, *length) - given_mm) <= rounding_mm;
}

/// Refuses a G10 that contradicts the given lengths, which the model has for the whole program.
void refuse_other_lengths(const Block& block, const Reading& r, const Word* l) {
  if (!sets_tool_length(r, l)) return;
  const Word* p = r.sorted.word('P');
  for (const auto& [tool, given_mm] : r.options.tool_lengths_mm) {
    const bool of_tool = p == nullptr || !p->literal || count_of(*p) == tool;
    if (!of_tool || sets_same_length(r, l, given_mm)) continue;
    refuse_word(
        block, r, *r.sorted.find(Action::set_data)->word,
        fmt::format("G10 may set the length of T{}, which is given as {:.6g} mm; give the length that "
                    "the program sets ([tools.T{}], --tool-table or --tool-length), or remove the "
                    "block",
                    tool, given_mm, tool));
  }
}

}  // namespace

void apply_work_offset(const Block& block, Reading& r) {
  const FoundG* offset = r.sorted.find(Action::work_offset);
  if (offset == nullptr) return;
  const std::optional<std::string> name = offset_name(block, r, *offset);
  if (!name) {
    r.state.unknown_modes |= unknown_offset;
    r.state.known.fill(false);
    return note_uncorrected(block, r, why_not_followed(r));
  }
  if (*name != offset_that_acts(r)) {
    end_contour(r);
    // Controls differ in whether a local shift also applies in the other offset.
    if (!r.state.shifts.local_mm.isZero(0) && !r.dialect.sinumerik_words) add_displacement(block, r, shifted);
    enter_frame(r, *name);
  }
  r.state.unknown_modes &= static_cast<std::uint16_t>(~unknown_offset);
  displace_by_data(r);
}

namespace {

void refuse_other_number(const Block& block, const Reading& r, const Word& h) {
  if (h.value >= 0 && h.value == std::floor(h.value)) return;
  refuse_word(block, r, h,
              fmt::format("H{} is not the number of a tool offset; use a whole number from 0 on", h.value));
}

bool changes_tool_length(const Reading& r) {
  if (r.sorted.has(Action::tool_length) || r.sorted.has(Action::no_tool_length)) return true;
  const bool is_argument =
      r.sorted.has(Action::call) || r.sorted.has(MAction::call) || (r.state.displaced & modal_macro) != 0;
  return r.dialect.macro_words && r.sorted.word('H') != nullptr && r.state.tool_length != 0.0 && !is_argument;
}

}  // namespace

void apply_tool_length(const Block& block, Reading& r) {
  r.sets_tool_length = changes_tool_length(r);
  if (!r.sets_tool_length) return;
  ModalState& state = r.state;
  std::optional<double> number, length_mm;
  const FoundG* found = r.sorted.find(Action::tool_length);
  const Word* h = r.sorted.word('H');
  const bool on = found != nullptr;
  const bool is_number = h != nullptr && h->literal;
  const bool off = !on && (r.sorted.has(Action::no_tool_length) || (is_number && h->value == 0));
  if (off)
    number = 0, length_mm = 0;
  else if (!on && is_number)
    number = h->value;
  const bool plain = on && (found->code->tenths == 430 || found->code->tenths == 440);
  if (plain && is_number) refuse_other_number(block, r, *h);
  if (plain) find_length(r, number, length_mm);
  if (length_mm && plain && found->code->tenths == 440) *length_mm = -*length_mm;
  // Shop controls add relative Z to the programmed position, independent of the length.
  const bool has_z = r.sorted.word('Z') != nullptr;
  const bool counts_on = r.dialect.macro_words && state.relative && has_z;
  const bool changes = length_mm != state.tool_length_mm;
  // In a block without Z a shop control moves Z by the change, or shifts the coordinates: Fanuc parameter
  // 5006#6.
  if (length_mm && state.tool_length_mm && changes && r.dialect.macro_words && !has_z)
    state.known[2] = false;
  else if (length_mm && state.tool_length_mm)
    state.position_mm.z() += *state.tool_length_mm - *length_mm;
  else if ((!number || number != state.tool_length) && !counts_on)
    state.known[2] = false;

  if (!number || number != state.tool_length || changes) state.cycle.initial.reset();
  state.tool_length = number;
  state.tool_length_mm = length_mm;
  if (!off && !std::exchange(r.uses_tool_length, true)) remark_cuts_before_length(r);
  if (!length_mm) remark_tool_length(block, r);
  const bool is_of_next_tool =
      number && r.state.tool_chosen && *number == static_cast<double>(*r.state.tool_chosen);
  if (on && !is_of_next_tool) remark_other_length(block.line, r);
}

void watch_other_axes(const Block& block, Reading& r) {
  if (r.sorted.has(Action::call) || r.sorted.has(Action::dwell) || r.sorted.has(Action::displace)) return;
  // Beside a position they turn the tool of a six-axis machine.
  const bool turns = may_turn_tool(r) && !r.sorted.has(Action::set_data) && !r.sorted.has(Action::shift);
  for (const char letter : std::string_view(turns ? "UVW" : "ABCUVW"))
    if (!is_zero_or_absent(r.sorted.word(letter)) && (r.state.displaced & rotary) == 0)
      add_displacement(block, r, rotary);
}

void apply_displacements(const Block& block, Reading& r) {
  end_displacements(r);
  bool followed = false;
  for (const FoundG& g : r.sorted.g) {
    if (limits_speed(r, *g.code)) continue;
    if (apply_frame_code(block, r, *g.code)) {
      followed = true;
      continue;
    }
    if (g.code->action == Action::displace) note_begin(r, *g.code), add_displacement(block, r, g.code->bit);
    if (g.code->tenths == 661) r.state.known.fill(false);  // its own block calls the macro, too
    if (g.code->bit == unknown) r.state.displaced |= unknown, end_contour(r);
  }
  if (r.sorted.has(Action::shift) && !followed) {
    const bool zero = is_zero_or_absent(r.sorted.word('X')) && is_zero_or_absent(r.sorted.word('Y')) &&
                      is_zero_or_absent(r.sorted.word('Z'));
    const bool all_named = r.sorted.word('X') && r.sorted.word('Y') && r.sorted.word('Z');
    // Under G91 a shop control may take the words as changes of the shift.
    const bool sets = !r.state.relative || !r.dialect.macro_words;
    if (zero && all_named && sets)
      end_local_shift(r);
    else if (!zero || has_local_shift(r))
      add_displacement(block, r, shifted);
  }
  watch_other_axes(block, r);
  if (r.sorted.has(MAction::kinematics)) add_displacement(block, r, kinematics);
}

void note_offset_set(Reading& r, std::string_view name) {
  r.state.offsets_set = name.empty() ? std::uint16_t{0xffff}
                                     : static_cast<std::uint16_t>(r.state.offsets_set | offset_bit(name));
  displace_by_data(r);
  if ((r.state.displaced & data) != 0) r.state.known.fill(false), end_contour(r);
}

void apply_set_data(const Block& block, Reading& r) {
  if (r.sorted.has(Action::end_data)) r.state.entering_data = false;
  if (!r.sorted.has(Action::set_data)) return;
  const Word* l = r.sorted.word('L');
  r.state.entering_data = r.dialect.macro_words && l != nullptr && l->value >= 50;
  if (l != nullptr && !l->literal)
    return lose_offsets(block, r, "G10 with a computed L may set offsets or tools");
  if (sets_offset(l) && set_work_offset(block, r)) return;
  const Word* p = r.sorted.word('P');
  const bool of_active = (r.dialect.family & (linuxcnc_family | grbl_family)) != 0;
  const bool sets_one = sets_offset(l) && (l->value == 2 || of_active) && p != nullptr && p->literal &&
                        p->value >= 1 && p->value <= 9;
  note_uncorrected(block, r,
                   sets_one && l->value == 20
                       ? "G10 L20 sets a work offset by the position of the tool, which is not followed"
                       : "G10 sets offsets or tools");
  if (sets_tools(r, l)) {
    refuse_other_lengths(block, r, l);
    if (sets_tool_length(r, l)) lose_active_length(r);
    return;
  }
  if (!sets_offset(l)) return;
  if (p != nullptr && p->literal && p->value == 0 && of_active) {
    r.state.offsets_set |= offset_bit(offset_that_acts(r));
  } else {
    r.state.offsets_set =
        sets_one ? static_cast<std::uint16_t>(r.state.offsets_set | 1u << (static_cast<int>(p->value) - 1))
                 : std::uint16_t{0xffff};
  }
  displace_by_data(r);
  if ((r.state.displaced & data) != 0) r.state.known.fill(false), end_contour(r);
}

void apply_variables(const Block& block, Reading& r) {
  for (const Assignment& assignment : block.assignments)
    if (may_be_offset(part(r.program.text, assignment.variable), r))
      return lose_offsets(block, r, "a variable of the control may set offsets or tools");
}

void apply_parameter(const Block& block, Reading& r) {
  constexpr double first_of_offsets = 1220, last_of_offsets = 1299;  // Fanuc: work offsets
  const Word* n = r.sorted.word('N');
  if (r.state.entering_data && n != nullptr && n->value >= first_of_offsets && n->value <= last_of_offsets)
    lose_offsets(block, r, "a parameter sets a work offset");
}

namespace {

/// G5.1 Q2 X0 Y0 of Fanuc: the axes of smooth interpolation. They do not move.
bool selects_axes(const Reading& r, const FoundG& smooth) {
  const Word* q = r.sorted.word('Q');
  return smooth.code->tenths == 51 && q != nullptr && q->literal && (q->value == 2 || q->value == 3);
}

}  // namespace

bool ends_all_axes(const Reading& r, const GCode& code) {
  constexpr Letters linear = letter_bit('X') | letter_bit('Y') | letter_bit('Z');
  const bool of_named_axes = code.bit == mirrored || (code.tenths == 921 && r.dialect.macro_words);
  return !of_named_axes || named_axes(r) == 0 || (named_axes(r) & linear) == linear;
}

bool takes_axis_words(const Reading& r) {
  if (r.state.entering_data) return true;
  return std::any_of(r.sorted.g.begin(), r.sorted.g.end(), [&](const FoundG& g) {
    switch (g.code->action) {
      case Action::set_data:
      case Action::shift:
      case Action::limits:
        return true;
      case Action::smooth:
        return selects_axes(r, g);
      case Action::displace:
        return g.code->bit != tool_point && g.code->bit != polar;
      default:
        return g.code->tenths == 220 || g.code->tenths == 281 || g.code->tenths == 301 ||
               g.code->tenths == 431 || g.code->tenths == 501 || g.code->tenths == 1000 ||
               (g.code->tenths == 921 && r.dialect.macro_words);
    }
  });
}

}  // namespace counterflex
