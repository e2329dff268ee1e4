#pragma once
/// What differs between controls that read G-code, as data.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// Controls that share codes, as bits.
enum Family : unsigned {
  linuxcnc_family = 1,
  grbl_family = 2,
  fanuc_family = 4,
  haas_family = 8,
  mach3_family = 16,
  siemens_family = 32,
  shop_families = fanuc_family | haas_family,
  any_family = 31
};

/// By how much (mm) an arc's radii at its start and at its end may differ: by `always`, or by a thousandth of the
/// radius, but by no more than `most`.
struct RadiusRoom {
  double always = 0, most = std::numeric_limits<double>::infinity();
};

inline bool radii_agree(const RadiusRoom& room, double start_mm, double end_mm) {
  constexpr double share = 1e-3, rounding = 1e-9;
  const double off = std::abs(end_mm - start_mm) - rounding;
  return off <= room.always || (off <= room.most && off <= share * std::max(start_mm, end_mm));
}

struct Dialect {
  std::string_view name;
  unsigned family = linuxcnc_family;
  std::size_t line_limit = 0;         ///< characters of a line; 0: none known
  bool limit_counts_comments = true;  ///< whether blanks and comments count
  bool semicolon_comments = true;     ///< else ';' may only end a block
  bool motion_ends_with_g80 = true;   ///< else G80 falls back to G0
  bool feed_mode_ends_feed =
      false;  ///< F must be programmed anew after any G93, G94 or G95, else after a change
  bool feed_before_unit = false;  ///< F beside G20 or G21 is read in the unit before
  bool tool_change_moves_axes = false;
  bool integer_words_doubtful = false;   ///< X5 may mean 5 units or 5 increments
  bool g61_is_exact_stop = false;        ///< else G61 is exact path
  bool h_and_d_stand_alone = false;      ///< H and D are modal words of their own
  bool dwell_takes_axis_words = false;   ///< G4 X1.5 dwells
  bool block_delete_numbers = false;     ///< '/2', and '/' behind N
  bool number_anywhere = true;           ///< N need not stand first
  bool reference_beside_motion = false;  ///< G0 G28: else an error
  bool macro_words = false;              ///< IF, GOTO, WHILE, and assignments up to the end of the line
  bool o_words = false;                  ///< o<name> sub, if, while, call
  bool parentheses_nest = false;         ///< a '(' in a comment is a character like others
  bool comments_may_stay_open = false;   ///< up to the end of the line
  bool percent_names = false;            ///< "%O1" or "%PART" at the beginning, ":1" for "O1"
  bool sinumerik_words = false;          ///< X=IC(5), CR=4., R1=5, names, labels; ';' begins comments
  std::string_view radius_name = "R";    ///< of an arc
  RadiusRoom radius_room{0.0283, 2.83};  ///< of a program in mm; LinuxCNC's, found by trying
  RadiusRoom radius_room_inch{0.00283 * 25.4, 0.283 * 25.4};
};

/// The name of Heidenhain Klartext, which is spelt otherwise than G-code.
inline constexpr std::string_view klartext_name = "heidenhain";

inline constexpr char comment_open = '(';
inline constexpr char comment_close = ')';

/// The dialect of that name, or nullptr.
const Dialect* find_dialect(std::string_view name);

/// Names for diagnostics, with commas.
std::string dialect_names();

/// Digits after the point of the resolution: 0.001 mm, 0.0001 inch.
constexpr int resolution_decimals(LengthUnit unit) {
  return unit == LengthUnit::millimetres ? 3 : 4;
}

/// How many mm one unit is.
constexpr double mm_per(LengthUnit unit) {
  return unit == LengthUnit::millimetres ? 1.0 : 25.4;
}

/// A length as its unit has it.
constexpr double in_unit(double length_mm, LengthUnit unit) {
  return unit == LengthUnit::millimetres ? length_mm : length_mm / mm_per(unit);
}

}  // namespace counterflex
