#include "program/gcode/words/codes.hpp"

#include <algorithm>
#include <array>

#include "program/siemens/codes.hpp"

namespace counterflex {
namespace {

constexpr unsigned not_mach = any_family & ~mach3_family;
constexpr unsigned linux_like = linuxcnc_family | grbl_family;
constexpr unsigned not_shop = linux_like | mach3_family;

constexpr std::string_view points_of_turning = "polar interpolation";
constexpr std::string_view points = "tool centre point control";

// Sorted by number. Entries with the same number have different families.
constexpr std::array g_codes{
    GCode{0, Action::rapid, CodeGroup::motion},
    GCode{10, Action::feed, CodeGroup::motion},
    GCode{20, Action::arc, CodeGroup::motion},
    GCode{30, Action::arc, CodeGroup::motion},
    GCode{40, Action::dwell},
    GCode{50, Action::spline, CodeGroup::motion, {}, linux_like},
    GCode{50, Action::smooth, CodeGroup::none, {}, shop_families},
    GCode{51, Action::spline, CodeGroup::motion, {}, linux_like},
    GCode{51, Action::smooth, CodeGroup::none, {}, shop_families},
    GCode{52, Action::spline, CodeGroup::motion, {}, linux_like},
    GCode{53, Action::spline, CodeGroup::motion, {}, linux_like},
    GCode{70, Action::not_read, CodeGroup::none, "diameter programming is not supported", not_mach},
    GCode{80, Action::smooth, CodeGroup::none, {}, shop_families},
    GCode{80, Action::state, CodeGroup::none, {}, linux_like},
    GCode{90, Action::stop_once, CodeGroup::none, {}, shop_families},
    GCode{100, Action::set_data},
    GCode{110, Action::end_data, CodeGroup::none, {}, shop_families},
    GCode{120, Action::pocket, CodeGroup::none, {}, shop_families | mach3_family},
    GCode{121, Action::displace, CodeGroup::none, points_of_turning, shop_families, polar},
    GCode{130, Action::pocket, CodeGroup::none, {}, shop_families | mach3_family},
    GCode{131, Action::end_displace, CodeGroup::none, {}, shop_families, polar},
    GCode{150, Action::end_displace, CodeGroup::none, {}, shop_families | mach3_family, polar},
    GCode{160, Action::displace, CodeGroup::none, "polar coordinates", shop_families | mach3_family, polar},
    GCode{170, Action::plane, CodeGroup::plane},
    GCode{180, Action::plane, CodeGroup::plane},
    GCode{190, Action::plane, CodeGroup::plane},
    GCode{200, Action::inches, CodeGroup::unit},
    GCode{210, Action::millimetres, CodeGroup::unit},
    GCode{220, Action::state, CodeGroup::none, {}, shop_families},
    GCode{230, Action::state, CodeGroup::none, {}, shop_families},
    GCode{270, Action::reference_move, CodeGroup::none, {}, shop_families},
    GCode{280, Action::reference_move},
    GCode{281, Action::state, CodeGroup::none, {}, linux_like},
    GCode{281, Action::reference_move, CodeGroup::none, {}, shop_families | mach3_family},
    GCode{290, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{300, Action::reference_move},
    GCode{301, Action::state, CodeGroup::none, {}, linux_like},
    GCode{301, Action::reference_move, CodeGroup::none, {}, shop_families | mach3_family},
    GCode{310, Action::probe, CodeGroup::none, {}, shop_families | mach3_family},
    GCode{330, Action::thread, CodeGroup::motion},
    GCode{331, Action::thread, CodeGroup::motion},
    GCode{382, Action::probe, CodeGroup::motion},
    GCode{383, Action::probe, CodeGroup::motion},
    GCode{384, Action::probe, CodeGroup::motion},
    GCode{385, Action::probe, CodeGroup::motion},
    GCode{400, Action::no_cutter, CodeGroup::cutter},
    GCode{410, Action::cutter, CodeGroup::cutter},
    GCode{411, Action::cutter, CodeGroup::cutter},
    GCode{420, Action::cutter, CodeGroup::cutter},
    GCode{421, Action::cutter, CodeGroup::cutter},
    GCode{430, Action::tool_length, CodeGroup::tool_length},
    GCode{431, Action::tool_length, CodeGroup::tool_length},
    GCode{432, Action::tool_length, CodeGroup::tool_length},
    GCode{434, Action::displace, CodeGroup::tool_length, points, any_family, tool_point},
    GCode{435, Action::displace, CodeGroup::tool_length, points, any_family, tool_point},
    GCode{440, Action::tool_length, CodeGroup::tool_length, {}, shop_families | mach3_family},
    GCode{450, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{460, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{470, Action::engrave, CodeGroup::none, {}, shop_families},
    GCode{480, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{490, Action::no_tool_length, CodeGroup::tool_length},
    GCode{500, Action::end_displace, CodeGroup::none, {}, shop_families | mach3_family, scaled},
    GCode{501, Action::end_displace, CodeGroup::none, {}, shop_families, mirrored},
    GCode{510, Action::displace, CodeGroup::none, "scaling", shop_families | mach3_family, scaled},
    GCode{511, Action::displace, CodeGroup::none, "mirroring", shop_families, mirrored},
    GCode{520, Action::shift, CodeGroup::none, "a shift by G52", any_family, shifted},
    GCode{530, Action::machine_move},
    GCode{540, Action::work_offset, CodeGroup::offset},
    GCode{541, Action::work_offset, CodeGroup::offset, {}, shop_families},
    GCode{550, Action::work_offset, CodeGroup::offset},
    GCode{560, Action::work_offset, CodeGroup::offset},
    GCode{570, Action::work_offset, CodeGroup::offset},
    GCode{580, Action::work_offset, CodeGroup::offset},
    GCode{590, Action::work_offset, CodeGroup::offset},
    GCode{591, Action::work_offset, CodeGroup::offset},
    GCode{592, Action::work_offset, CodeGroup::offset},
    GCode{593, Action::work_offset, CodeGroup::offset},
    GCode{610, Action::g61, CodeGroup::path},
    GCode{611, Action::exact_stop, CodeGroup::path},
    GCode{620, Action::state, CodeGroup::path, {}, shop_families},
    GCode{630, Action::state, CodeGroup::path, {}, shop_families},
    GCode{640, Action::blend, CodeGroup::path},
    GCode{650, Action::call, CodeGroup::none, {}, shop_families},
    GCode{660, Action::displace, CodeGroup::none, "a modal macro call", shop_families, modal_macro},
    GCode{661, Action::displace, CodeGroup::none, "a modal macro call", shop_families, modal_macro},
    GCode{670, Action::end_displace, CodeGroup::none, {}, shop_families, modal_macro},
    GCode{680, Action::displace, CodeGroup::none, "rotation", shop_families | mach3_family, rotated},
    GCode{682, Action::displace, CodeGroup::none, "a tilted plane", shop_families, rotated},
    GCode{690, Action::end_displace, CodeGroup::none, {}, shop_families | mach3_family, rotated},
    GCode{700, Action::inches, CodeGroup::unit, {}, mach3_family},
    GCode{700, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{710, Action::millimetres, CodeGroup::unit, {}, mach3_family},
    GCode{710, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{720, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{730, Action::cycle, CodeGroup::motion},
    GCode{740, Action::cycle, CodeGroup::motion},
    GCode{760, Action::cycle, CodeGroup::motion, {}, shop_families | mach3_family},
    GCode{760, Action::thread, CodeGroup::motion, {}, linux_like},
    GCode{770, Action::cycle, CodeGroup::motion, {}, shop_families},
    GCode{800, Action::end_motion},
    GCode{810, Action::cycle, CodeGroup::motion},
    GCode{820, Action::cycle, CodeGroup::motion},
    GCode{830, Action::cycle, CodeGroup::motion},
    GCode{840, Action::cycle, CodeGroup::motion},
    GCode{842, Action::cycle, CodeGroup::motion, {}, shop_families},
    GCode{843, Action::cycle, CodeGroup::motion, {}, shop_families},
    GCode{850, Action::cycle, CodeGroup::motion},
    GCode{860, Action::cycle, CodeGroup::motion},
    GCode{870, Action::cycle, CodeGroup::motion},
    GCode{880, Action::cycle, CodeGroup::motion},
    GCode{890, Action::cycle, CodeGroup::motion},
    GCode{900, Action::absolute, CodeGroup::distance},
    GCode{901, Action::absolute_centres, CodeGroup::arc},
    GCode{910, Action::relative, CodeGroup::distance},
    GCode{911, Action::relative_centres, CodeGroup::arc},
    GCode{920, Action::displace, CodeGroup::none, "a position set by G92", any_family, set_position},
    GCode{921, Action::end_displace, CodeGroup::none, {}, any_family, set_position},
    GCode{922, Action::end_displace, CodeGroup::none, {}, any_family, set_position},
    GCode{923, Action::displace, CodeGroup::none, "a position set by G92", any_family, set_position},
    GCode{930, Action::inverse_time, CodeGroup::feed_mode},
    GCode{940, Action::feed_per_minute, CodeGroup::feed_mode},
    GCode{950, Action::feed_per_turn, CodeGroup::feed_mode},
    GCode{960, Action::surface_speed, CodeGroup::spindle},
    GCode{970, Action::spindle_speed, CodeGroup::spindle},
    GCode{980, Action::initial_level, CodeGroup::retract},
    GCode{990, Action::retract_level, CodeGroup::retract},
    GCode{1000, Action::end_displace, CodeGroup::none, {}, haas_family, mirrored},
    GCode{1010, Action::displace, CodeGroup::none, "mirroring", haas_family, mirrored},
    GCode{1030, Action::state, CodeGroup::none, {}, haas_family},
    GCode{1100, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1110, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1120, Action::displace, CodeGroup::none, points_of_turning, fanuc_family, polar},
    GCode{1120, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1130, Action::end_displace, CodeGroup::none, {}, fanuc_family, polar},
    GCode{1130, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1140, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1150, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1160, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1170, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1180, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1190, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1200, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1210, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1220, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1230, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1240, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1250, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1260, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1270, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1280, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1290, Action::work_offset, CodeGroup::offset, {}, haas_family},
    GCode{1430, Action::displace, CodeGroup::tool_length, points, shop_families, tool_point},
    GCode{1500, Action::own_way, CodeGroup::none, {}, shop_families},
    GCode{1540, Action::work_offset, CodeGroup::offset, {}, shop_families},
    GCode{1870, Action::smooth, CodeGroup::none, {}, haas_family},
    GCode{2340, Action::displace, CodeGroup::tool_length, points, shop_families, tool_point},
};

constexpr bool in_order() {
  return std::is_sorted(g_codes.begin(), g_codes.end(),
                        [](const GCode& a, const GCode& b) { return a.tenths < b.tenths; });
}
static_assert(in_order());

constexpr std::size_t table_size = g_codes.back().tenths + 1;
using FirstOf = std::array<std::uint8_t, table_size>;

/// Index of the first code of a number, plus one; 0 if there is no such code.
constexpr FirstOf first_of = [] {
  FirstOf table{};
  for (std::size_t i = g_codes.size(); i-- > 0;)
    table[static_cast<std::size_t>(g_codes[i].tenths)] = static_cast<std::uint8_t>(i + 1);
  return table;
}();
static_assert(g_codes.size() < 255);

constexpr std::array acting_after{0, 1, 5, 9, 60};
constexpr std::array harmless{3, 4, 7, 8, 19, 29, 48, 49, 50, 51, 53, 61, 70, 71, 73};
constexpr std::array with_parameters{52, 62, 63, 64, 65, 66, 67, 68};

template <typename Codes>
bool contains(const Codes& codes, int code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

constexpr GCode not_known{0, Action::own_way, CodeGroup::none, "", any_family, unknown};

}  // namespace

const GCode& unknown_g_code() {
  return not_known;
}

const GCode* find_g_code(int tenths, const Dialect& dialect) {
  if (dialect.family == siemens_family) return find_siemens_code(tenths);
  if (tenths < 0 || static_cast<std::size_t>(tenths) >= table_size) return nullptr;
  const std::size_t first = first_of[static_cast<std::size_t>(tenths)];
  if (first == 0) return nullptr;
  for (const GCode* code = &g_codes[first - 1]; code != g_codes.end() && code->tenths == tenths; ++code)
    if ((code->families & dialect.family) != 0) return code;
  return nullptr;
}

MAction action_of_m(int code, const Dialect& dialect) {
  if (dialect.family == siemens_family) return action_of_siemens_m(code);
  if (code == 2 || code == 30) return MAction::end;
  if (code == 6 || (code == 16 && dialect.family == haas_family)) return MAction::tool_change;
  if (contains(acting_after, code)) return MAction::acts_after;
  if (code == 98 || code == 97 || (code == 198 && dialect.family != linuxcnc_family)) return MAction::call;
  if (code == 99 || (code == 47 && (not_shop & dialect.family) != 0)) return MAction::return_from_call;
  if (code == 72) return MAction::restore;
  if (code == 25) return MAction::retract;
  if (contains(harmless, code) || contains(with_parameters, code)) return MAction::state;
  const bool switches = (linux_like & dialect.family) != 0 && code >= 428 && code <= 430;
  return switches ? MAction::kinematics : MAction::machine;
}

}  // namespace counterflex
