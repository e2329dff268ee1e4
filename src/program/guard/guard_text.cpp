#include "program/guard/guard_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

#include "program/dialect.hpp"
#include "program/gcode/guard.hpp"
#include "program/klartext/guard.hpp"
#include "program/robot/fanuc/guard.hpp"
#include "program/robot/kuka/guard.hpp"
#include "program/robot/rapid/guard.hpp"
#include "program/robot/ur/guard.hpp"
#include "program/siemens/guard.hpp"

namespace counterflex {
namespace {

const std::array languages{
    GuardLanguage{"linuxcnc", linuxcnc_guard, why_no_linuxcnc_guard},
    GuardLanguage{"fanuc", fanuc_guard, why_no_fanuc_guard},
    GuardLanguage{"haas", haas_guard, why_no_haas_guard},
    GuardLanguage{"siemens", siemens_guard, why_no_siemens_guard},
    GuardLanguage{klartext_name, klartext_guard, why_no_klartext_guard, {"Q199", "\"CFGUARD"}},
    GuardLanguage{kuka_name, kuka_guard, why_no_kuka_guard},
    GuardLanguage{abb_name, rapid_guard, why_no_rapid_guard},
    GuardLanguage{tp_name, tp_guard, why_no_tp_guard, {"PR[100", "LBL[32701", "LBL[32702"}},
    GuardLanguage{ur_name, ur_guard, why_no_ur_guard},
};

const GuardLanguage* language_of(std::string_view dialect) {
  const auto found = std::find_if(languages.begin(), languages.end(),
                                  [&](const GuardLanguage& l) { return l.dialect == dialect; });
  return found == languages.end() ? nullptr : &*found;
}

std::string names_of_languages() {
  std::string names;
  for (const GuardLanguage& language : languages)
    names += (names.empty() ? "" : ", ") + std::string(language.dialect);
  return names;
}

bool cuts(const Move& move) {
  return move.motion == Motion::feed || move.cycle || move.called || move.makes_hole || move.mills_at_end;
}

}  // namespace

const Move* first_cut(const Program& window) {
  const auto found = std::find_if(window.moves.begin(), window.moves.end(), cuts);
  return found == window.moves.end() ? nullptr : &*found;
}

std::string why_no_guard(const std::string& dialect, const Guard& guard) {
  const GuardLanguage* language = language_of(dialect);
  if (language != nullptr) return language->why_not(guard);
  return fmt::format(
      "{} has no condition that reads work offset and tool and stops the program: there is no guard for it, "
      "leave out --guard (it is for {})",
      dialect, names_of_languages());
}

std::string reserved_for_guard(const std::string& dialect, std::string_view text) {
  const GuardLanguage* language = language_of(dialect);
  if (language == nullptr) return "";
  const auto found =
      std::find_if(language->reserved.begin(), language->reserved.end(),
                   [&](std::string_view name) { return text.find(name) != std::string_view::npos; });
  return found == language->reserved.end() ? "" : std::string(*found);
}

std::string guard_text(const std::string& dialect, const Guard& guard, const std::string& line_end,
                       const std::string& line_begin) {
  const GuardLanguage* language = language_of(dialect);
  assert(language != nullptr);
  std::string text;
  for (const std::string& line : language->lines(guard))
    text.append(line_begin).append(line).append(line_end);
  return text;
}

std::string guard_number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

GuardedValue guarded_value(double value_mm, double window_mm, LengthUnit unit) {
  constexpr double steps = 1e6, rounding = 1e-6;
  const double value = value_mm / mm_per(unit);
  const double window = std::floor(window_mm / mm_per(unit) * steps + rounding) / steps;
  const std::string_view name = unit == LengthUnit::inches ? "INCH" : "MM";
  return {guard_number(value), guard_number(window),
          fmt::format("{} TO {} {}", guard_number(value - window), guard_number(value + window), name)};
}

GuardedValue guarded_turn(const Guard& guard) {
  constexpr double window = 1e-4;  // deg: 2 µm in a metre
  const double turn = guard.turn_deg.value_or(0);
  return {guard_number(turn), guard_number(window), fmt::format("{} DEG", guard_number(turn))};
}

std::string why_no_guard_of_tilted(const Guard& guard) {
  if (guard.turn_deg) return "";
  return fmt::format(
      "{} is turned about X or Y, and the checks compare a turn about Z alone: leave out --guard",
      guard.active.name);
}

std::string guard_title(const Guard& guard) {
  const Vector3& p = guard.active.shown_mm;
  return fmt::format("COUNTERFLEX 1 GUARD: CORRECTED FOR {} AT X{} Y{} Z{} MM, HOLDS WITHIN {} MM",
                     guard.active.name.empty() ? "THE WORLD FRAME" : guard.active.name, guard_number(p.x()),
                     guard_number(p.y()), guard_number(p.z()), guard_number(guard.window_mm));
}

OffsetNumber number_of_offset(std::string_view name) {
  constexpr std::array basic{"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};
  const auto found = std::find(basic.begin(), basic.end(), name);
  if (found != basic.end()) return {static_cast<int>(found - basic.begin()) + 1, 0};
  constexpr std::string_view additional = "G54.1 P";
  OffsetNumber number;
  if (name.starts_with(additional))
    std::from_chars(name.data() + additional.size(), name.data() + name.size(), number.additional);
  return number;
}

}  // namespace counterflex
