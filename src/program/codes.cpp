#include "program/codes.hpp"

#include <algorithm>
#include <array>

namespace counterflex {
namespace {

constexpr std::string_view arcs = "arcs are not read yet";
constexpr std::string_view cycles = "canned cycles are not read yet";
constexpr std::string_view splines = "splines are not read yet";
constexpr std::string_view threads = "threads and tapping are not read yet";
constexpr std::string_view probing = "probing is not read yet";
constexpr std::string_view contours = "cutter compensation is not read yet";
constexpr std::string_view shifts = "shifts of coordinates are not read yet";
constexpr std::string_view turns = "scaling, mirroring and rotation are not read yet";
constexpr std::string_view polar = "polar coordinates are not read yet";
constexpr std::string_view dynamic_tool = "dynamic tool offsets are not read yet";
constexpr std::string_view five_axes = "tool centre point control is not read yet";
constexpr std::string_view macros = "macro calls are not read yet";

// In the order of their numbers.
constexpr std::array g_codes{
    GCode{0, Action::rapid, Group::motion},
    GCode{10, Action::feed, Group::motion},
    GCode{20, Action::not_read, Group::motion, arcs},
    GCode{30, Action::not_read, Group::motion, arcs},
    GCode{40, Action::dwell},
    GCode{50, Action::not_read, Group::motion, splines},
    GCode{51, Action::smooth, Group::none, {}, true},
    GCode{52, Action::not_read, Group::motion, splines},
    GCode{53, Action::not_read, Group::motion, splines},
    GCode{70, Action::not_read, Group::none, "diameter programming is not read yet"},
    GCode{80, Action::state},
    GCode{90, Action::stop_once, Group::none, {}, true},
    GCode{100, Action::not_read, Group::none, "setting offsets is not read yet"},
    GCode{120, Action::not_read, Group::motion, cycles},
    GCode{130, Action::not_read, Group::motion, cycles},
    GCode{150, Action::state, Group::none, {}, true},
    GCode{160, Action::not_read, Group::none, polar},
    GCode{170, Action::state, Group::plane},
    GCode{180, Action::state, Group::plane},
    GCode{190, Action::state, Group::plane},
    GCode{200, Action::inch, Group::unit},
    GCode{210, Action::mm, Group::unit},
    GCode{280, Action::reference_move},
    GCode{281, Action::not_read, Group::none, "setting the reference point is not read yet"},
    GCode{300, Action::reference_move},
    GCode{301, Action::not_read, Group::none, "setting the reference point is not read yet"},
    GCode{310, Action::not_read, Group::none, probing},
    GCode{330, Action::not_read, Group::motion, threads},
    GCode{331, Action::not_read, Group::motion, threads},
    GCode{382, Action::not_read, Group::motion, probing},
    GCode{383, Action::not_read, Group::motion, probing},
    GCode{384, Action::not_read, Group::motion, probing},
    GCode{385, Action::not_read, Group::motion, probing},
    GCode{400, Action::state, Group::cutter},
    GCode{410, Action::not_read, Group::cutter, contours},
    GCode{411, Action::not_read, Group::cutter, contours},
    GCode{420, Action::not_read, Group::cutter, contours},
    GCode{421, Action::not_read, Group::cutter, contours},
    GCode{430, Action::tool_length, Group::tool_length},
    GCode{431, Action::not_read, Group::tool_length, dynamic_tool},
    GCode{432, Action::not_read, Group::tool_length, dynamic_tool},
    GCode{434, Action::not_read, Group::tool_length, five_axes},
    GCode{435, Action::not_read, Group::tool_length, five_axes},
    GCode{440, Action::tool_length, Group::tool_length, {}, true},
    GCode{470, Action::not_read, Group::none, "engraving is not read yet"},
    GCode{490, Action::no_tool_length, Group::tool_length},
    GCode{500, Action::state, Group::none, {}, true},
    GCode{501, Action::state, Group::none, {}, true},
    GCode{510, Action::not_read, Group::none, turns},
    GCode{511, Action::not_read, Group::none, turns},
    GCode{520, Action::not_read, Group::none, shifts},
    GCode{530, Action::machine_move},
    GCode{540, Action::work_offset, Group::offset},
    GCode{541, Action::not_read, Group::offset, "additional work offsets are not read yet"},
    GCode{550, Action::work_offset, Group::offset},
    GCode{560, Action::work_offset, Group::offset},
    GCode{570, Action::work_offset, Group::offset},
    GCode{580, Action::work_offset, Group::offset},
    GCode{590, Action::work_offset, Group::offset},
    GCode{591, Action::work_offset, Group::offset},
    GCode{592, Action::work_offset, Group::offset},
    GCode{593, Action::work_offset, Group::offset},
    GCode{610, Action::g61, Group::path},
    GCode{611, Action::exact_stop, Group::path},
    GCode{640, Action::blend, Group::path},
    GCode{650, Action::not_read, Group::none, macros},
    GCode{660, Action::not_read, Group::none, macros},
    GCode{670, Action::state, Group::none, {}, true},
    GCode{680, Action::not_read, Group::none, turns},
    GCode{690, Action::state, Group::none, {}, true},
    GCode{730, Action::not_read, Group::motion, cycles},
    GCode{740, Action::not_read, Group::motion, cycles},
    GCode{760, Action::not_read, Group::motion, cycles},
    GCode{800, Action::end_motion},
    GCode{810, Action::not_read, Group::motion, cycles},
    GCode{820, Action::not_read, Group::motion, cycles},
    GCode{830, Action::not_read, Group::motion, cycles},
    GCode{840, Action::not_read, Group::motion, cycles},
    GCode{850, Action::not_read, Group::motion, cycles},
    GCode{860, Action::not_read, Group::motion, cycles},
    GCode{870, Action::not_read, Group::motion, cycles},
    GCode{880, Action::not_read, Group::motion, cycles},
    GCode{890, Action::not_read, Group::motion, cycles},
    GCode{900, Action::state, Group::distance},
    GCode{901, Action::state, Group::arc},
    GCode{910, Action::not_read, Group::distance, "incremental positions are not read yet"},
    GCode{911, Action::state, Group::arc},
    GCode{920, Action::not_read, Group::none, shifts},
    GCode{921, Action::not_read, Group::none, shifts},
    GCode{922, Action::not_read, Group::none, shifts},
    GCode{923, Action::not_read, Group::none, shifts},
    GCode{930, Action::not_read, Group::feed_mode, "inverse time feed is not read yet"},
    GCode{940, Action::feed_per_minute, Group::feed_mode},
    GCode{950, Action::feed_per_turn, Group::feed_mode},
    GCode{960, Action::not_read, Group::spindle, "constant surface speed is not read yet"},
    GCode{970, Action::state, Group::spindle},
    GCode{980, Action::state, Group::retract},
    GCode{990, Action::state, Group::retract},
    GCode{1540, Action::not_read, Group::offset, "additional work offsets are not read yet"},
    GCode{1870, Action::smooth, Group::none, {}, true},
};

constexpr bool in_order() {
  return std::is_sorted(g_codes.begin(), g_codes.end(),
                        [](const GCode& a, const GCode& b) { return a.tenths < b.tenths; });
}
static_assert(in_order());

constexpr std::array acting_after{0, 1, 5, 9, 60};
constexpr std::array harmless{3, 4, 7, 8, 19, 48, 49, 50, 51, 53, 61};
constexpr std::array with_parameters{52, 62, 63, 64, 65, 66, 67, 68};
constexpr std::array refused{70, 71, 72, 73, 96, 97, 98, 99};

template <typename Codes>
bool contains(const Codes& codes, int code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

}  // namespace

const GCode* find_g_code(int tenths, const Dialect& dialect) {
  const auto found = std::lower_bound(g_codes.begin(), g_codes.end(), tenths,
                                      [](const GCode& code, int wanted) { return code.tenths < wanted; });
  if (found == g_codes.end() || found->tenths != tenths) return nullptr;
  return found->shop_only && !dialect.machine_state_codes ? nullptr : &*found;
}

MAction action_of_m(int code, const Dialect& dialect) {
  if (code == 2 || code == 30) return MAction::end;
  if (code == 6) return MAction::tool_change;
  if (contains(acting_after, code)) return MAction::acts_after;
  if (contains(harmless, code) || contains(with_parameters, code)) return MAction::state;
  // M428, M429 and M430 switch the kinematics of LinuxCNC's five-axis machines.
  const bool kinematics = !dialect.machine_state_codes && code >= 428 && code <= 430;
  return contains(refused, code) || kinematics ? MAction::not_read : MAction::machine;
}

}  // namespace counterflex
