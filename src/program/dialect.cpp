#include "program/dialect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "counterflex/program/dialects.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {
namespace {

constexpr Dialect linuxcnc{.name = "linuxcnc",
                           .family = linuxcnc_family,
                           .line_limit = 255,
                           .feed_mode_ends_feed = true,
                           .feed_before_unit = true,
                           .number_anywhere = false,
                           .keeps_level = true,
                           .o_words = true};

constexpr Dialect grbl{.name = "grbl",
                       .family = grbl_family,
                       .line_limit = 80,
                       .limit_counts_comments = false,
                       .g61_is_exact_stop = false,
                       .parentheses_nest = true,
                       .comments_may_stay_open = true,
                       .radius_room = {0.005, 0.5},
                       .radius_room_inch = {0.005, 0.5}};

constexpr Dialect shop_control(std::string_view name, unsigned family) {
  return {.name = name,
          .family = family,
          .semicolon_comments = false,
          .motion_ends_with_g80 = false,
          .tool_change_moves_axes = true,
          .integer_words_ambiguous = true,
          .g61_is_exact_stop = true,
          .h_and_d_are_modal = true,
          .dwell_takes_axis_words = true,
          .block_delete_numbers = true,
          .reference_beside_motion = true,
          .macro_words = true,
          .k_repeats_holes = (family & fanuc_family) != 0,
          .parentheses_nest = true,
          .comments_may_stay_open = true,
          .percent_names = true};
}

constexpr Dialect fanuc = shop_control("fanuc", fanuc_family);
constexpr Dialect haas = shop_control("haas", haas_family);

constexpr Dialect mach3{.name = "mach3",
                        .family = mach3_family,
                        .motion_ends_with_g80 = false,
                        .tool_change_moves_axes = true,
                        .g61_is_exact_stop = true,
                        .h_and_d_are_modal = true,
                        .reference_beside_motion = true,
                        .parentheses_nest = true,
                        .comments_may_stay_open = true};

constexpr Dialect siemens{.name = "siemens",
                          .family = siemens_family,
                          .line_limit = 512,
                          .motion_ends_with_g80 = false,
                          .tool_change_moves_axes = true,
                          .h_and_d_are_modal = true,
                          .reference_beside_motion = true,
                          .sinumerik_words = true,
                          .radius_name = "CR=",
                          .radius_room = {0.01},
                          .radius_room_inch = {0.01}};

/// Klartext, which has its own reader.
// iTNC 530: "input tolerance up to 0.016 mm" for the start and end of an arc.
constexpr Dialect heidenhain{.name = klartext_name,
                             .tool_change_moves_axes = true,
                             .radius_room = {0.016},
                             .radius_room_inch = {0.016}};

constexpr Dialect robot(std::string_view name, std::string_view language) {
  return {.name = name, .language = language, .family = 0};
}
constexpr Dialect kuka = robot(kuka_name, "KUKA KRL"), abb = robot(abb_name, "ABB RAPID"),
                  ur = robot(ur_name, "URScript"), apt = robot(apt_name, "APT"),
                  tp = robot(tp_name, "FANUC TP (LS)"), yaskawa = robot(yaskawa_name, "Yaskawa INFORM");

constexpr std::array dialects{&linuxcnc, &grbl, &fanuc, &haas, &mach3, &siemens, &heidenhain,
                              &kuka,     &abb,  &ur,    &apt,  &tp,    &yaskawa};

}  // namespace

const Dialect* find_dialect(std::string_view name) {
  for (const Dialect* dialect : dialects)
    if (dialect->name == name) return dialect;
  return nullptr;
}

std::string_view robot_language_of(std::string_view dialect) {
  const Dialect* found = find_dialect(dialect);
  return found != nullptr ? found->language : std::string_view{};
}

bool is_robot_dialect(std::string_view dialect) {
  return !robot_language_of(dialect).empty();
}

std::vector<std::string_view> known_dialects() {
  std::vector<std::string_view> names{"auto"};
  for (const Dialect* dialect : dialects) names.push_back(dialect->name);
  return names;
}

std::string dialect_names() {
  return fmt::format("{}", fmt::join(known_dialects(), ", "));
}

}  // namespace counterflex
