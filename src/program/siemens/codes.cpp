#include "program/siemens/codes.hpp"

#include <algorithm>
#include <array>

namespace counterflex {
namespace {

constexpr std::string_view iso = "the ISO mode of the control is not supported: give --dialect fanuc";
constexpr std::string_view a_cycle = "a cycle";

// Sorted by number.
constexpr std::array siemens_codes{
    GCode{0, Action::rapid, CodeGroup::motion},
    GCode{10, Action::feed, CodeGroup::motion},
    GCode{20, Action::arc, CodeGroup::motion},
    GCode{30, Action::arc, CodeGroup::motion},
    GCode{40, Action::dwell},
    GCode{90, Action::stop_once},
    GCode{170, Action::plane, CodeGroup::plane},
    GCode{180, Action::plane, CodeGroup::plane},
    GCode{190, Action::plane, CodeGroup::plane},
    GCode{250, Action::limits},
    GCode{260, Action::limits},
    GCode{330, Action::thread, CodeGroup::motion},
    GCode{340, Action::thread, CodeGroup::motion},
    GCode{350, Action::thread, CodeGroup::motion},
    GCode{400, Action::no_cutter, CodeGroup::cutter},
    GCode{410, Action::cutter, CodeGroup::cutter},
    GCode{420, Action::cutter, CodeGroup::cutter},
    GCode{530, Action::machine_move},
    GCode{540, Action::work_offset, CodeGroup::offset},
    GCode{550, Action::work_offset, CodeGroup::offset},
    GCode{560, Action::work_offset, CodeGroup::offset},
    GCode{570, Action::work_offset, CodeGroup::offset},
    GCode{580, Action::displace, CodeGroup::none, "a shift", any_family, shifted},
    GCode{590, Action::displace, CodeGroup::none, "a shift", any_family, shifted},
    GCode{600, Action::exact_stop, CodeGroup::path},
    GCode{620, Action::state},
    GCode{630, Action::own_way},
    GCode{640, Action::blend, CodeGroup::path},
    GCode{700, Action::inches, CodeGroup::unit},
    GCode{710, Action::millimetres, CodeGroup::unit},
    GCode{740, Action::reference_move},
    GCode{750, Action::reference_move},
    GCode{800, Action::end_displace, CodeGroup::motion, {}, any_family, modal_macro},
    GCode{810, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{820, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{830, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{840, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{850, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{860, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{870, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{880, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{890, Action::displace, CodeGroup::motion, a_cycle, any_family, modal_macro},
    GCode{900, Action::absolute, CodeGroup::distance},
    GCode{910, Action::relative, CodeGroup::distance},
    GCode{930, Action::inverse_time, CodeGroup::feed_mode},
    GCode{940, Action::feed_per_minute, CodeGroup::feed_mode},
    GCode{950, Action::feed_per_turn, CodeGroup::feed_mode},
    GCode{960, Action::surface_speed, CodeGroup::spindle},
    GCode{970, Action::spindle_speed, CodeGroup::spindle},
    GCode{1100, Action::own_way},
    GCode{1110, Action::own_way},
    GCode{1120, Action::own_way},
    GCode{1400, Action::state},
    GCode{1410, Action::state},
    GCode{1420, Action::state},
    GCode{1430, Action::state},
    GCode{1470, Action::own_way},
    GCode{1480, Action::own_way},
    GCode{1530, Action::machine_move},
    GCode{2470, Action::own_way},
    GCode{2480, Action::own_way},
    GCode{2900, Action::state},
    GCode{2910, Action::not_read, CodeGroup::none, iso},
    GCode{3310, Action::own_way},
    GCode{3320, Action::own_way},
    GCode{3400, Action::state},
    GCode{3410, Action::state},
    GCode{3470, Action::own_way},
    GCode{3480, Action::own_way},
    GCode{4500, Action::state},
    GCode{4510, Action::state},
    GCode{4600, Action::state},
    GCode{4610, Action::state},
    GCode{4620, Action::state},
    GCode{5000, Action::work_offset, CodeGroup::offset},
    GCode{6010, Action::state},
    GCode{6020, Action::state},
    GCode{6030, Action::state},
    GCode{6210, Action::state},
    GCode{6410, Action::blend, CodeGroup::path},
    GCode{6420, Action::blend, CodeGroup::path},
    GCode{6430, Action::blend, CodeGroup::path},
    GCode{6440, Action::blend, CodeGroup::path},
    GCode{6450, Action::blend, CodeGroup::path},
    GCode{7000, Action::inches, CodeGroup::unit},
    GCode{7100, Action::millimetres, CodeGroup::unit},
    GCode{9610, Action::surface_speed, CodeGroup::spindle},
    GCode{9620, Action::surface_speed, CodeGroup::spindle},
    GCode{9710, Action::spindle_speed, CodeGroup::spindle},
    GCode{9720, Action::spindle_speed, CodeGroup::spindle},
    GCode{9730, Action::spindle_speed, CodeGroup::spindle},
};

/// G505 to G599.
constexpr GCode further_offset{5050, Action::work_offset, CodeGroup::offset};

constexpr bool siemens_in_order() {
  return std::is_sorted(siemens_codes.begin(), siemens_codes.end(),
                        [](const GCode& a, const GCode& b) { return a.tenths < b.tenths; });
}
static_assert(siemens_in_order());

}  // namespace

const GCode* find_siemens_code(int tenths) {
  if (tenths >= 5050 && tenths <= 5990 && tenths % 10 == 0) return &further_offset;
  const auto found = std::lower_bound(siemens_codes.begin(), siemens_codes.end(), tenths,
                                      [](const GCode& code, int wanted) { return code.tenths < wanted; });
  return found != siemens_codes.end() && found->tenths == tenths ? &*found : nullptr;
}

MAction action_of_siemens_m(int code) {
  constexpr std::array state{3, 4, 7, 8, 19, 40, 41, 42, 43, 44, 45, 70};
  constexpr std::array after{0, 1, 5, 9};
  if (code == 2 || code == 17 || code == 30) return MAction::end;
  if (code == 6) return MAction::tool_change;
  if (std::find(after.begin(), after.end(), code) != after.end()) return MAction::acts_after;
  return std::find(state.begin(), state.end(), code) != state.end() ? MAction::state : MAction::machine;
}

}  // namespace counterflex
