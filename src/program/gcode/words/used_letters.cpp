#include "program/gcode/words/used_letters.hpp"

namespace counterflex {
namespace {

constexpr Letters letters(std::string_view list) {
  Letters set = 0;
  for (const char letter : list) set |= letter_bit(letter);
  return set;
}

constexpr Letters all = ~Letters{0};
constexpr Letters always = letters("ABCFNOSTUVWXYZ");
constexpr Letters of_arcs = letters("IJKR");
constexpr Letters of_cycles = letters("DEHIJKLPQR");

/// One case per action: this is a table.
Letters used_by(Action action) {
  switch (action) {
    case Action::arc:
      return of_arcs;
    case Action::cycle:
    case Action::thread:
    case Action::spline:
    case Action::pocket:
      return of_cycles;
    case Action::engrave:
    case Action::own_way:
    case Action::call:
    case Action::displace:
    case Action::set_data:
      return all;
    case Action::dwell:
    case Action::reference_move:
    case Action::probe:
    case Action::work_offset:
      return letters("P");
    case Action::tool_length:
    case Action::no_tool_length:
      return letters("DH");
    case Action::cutter:
      return letters("DHL");
    case Action::blend:
      return letters("PQ");
    case Action::smooth:
      return letters("EPQR");
    case Action::surface_speed:  // G96 D1000 S50: the highest speed
      return letters("D");
    default:
      return 0;
  }
}

/// Letters of codes whose states do not affect moves.
Letters used_by_state(int tenths) {
  switch (tenths) {
    case 80:    // G8 P1
    case 1030:  // G103 P1
      return letters("P");
    case 220:
      return letters("IJK");
    default:
      return 0;
  }
}

Letters used_by(const FoundM& m) {
  if (m.action == MAction::machine || m.action == MAction::call) return letters("ELPQRHD");
  if (m.action == MAction::return_from_call) return letters("LP");
  switch (m.code) {
    case 3:
    case 4:
    case 5:
      return letters("P");  // power of some spindles and lasers
    case 19:
      return letters("PQR");
    case 50:
    case 51:
    case 52:
    case 53:
    case 62:
    case 63:
    case 64:
    case 65:
      return letters("P");
    case 61:  // M61 Q2: the tool in the spindle
      return letters("Q");
    case 66:
      return letters("ELPQ");
    case 67:
    case 68:
      return letters("EQ");
    default:
      return 0;
  }
}

}  // namespace

Letters used_letters(const SortedBlock& sorted, const Dialect& dialect, Context context) {
  Letters used = always;
  if (dialect.h_and_d_are_modal) used |= letters("DH");
  if (context == Context::arc) used |= of_arcs;
  const bool arc = context == Context::arc || sorted.has(Action::arc);
  if (arc && arcs_have_turns(dialect)) used |= letters("P");
  if (context == Context::cycle) used |= of_cycles;
  for (const FoundG& g : sorted.g) used |= used_by(g.code->action) | used_by_state(g.code->tenths);
  for (const FoundM& m : sorted.m) used |= used_by(m);
  return used;
}

}  // namespace counterflex
