#pragma once
/// Differences between controls that read G-code, as data.
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

/// Allowed difference (mm) between the radii at an arc's start and end: `always`, or a thousandth of the
/// radius if that is larger, but at most `most`.
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
  /// "KUKA KRL": a robot language, which has its own reader; no member but the name applies. Else empty.
  std::string_view language{};
  unsigned family = linuxcnc_family;
  std::size_t line_limit = 0;         ///< characters of a line; 0: no limit is known
  bool limit_counts_comments = true;  ///< whether blanks and comments count
  bool semicolon_comments = true;     ///< if false, ';' may only end a block
  bool motion_ends_with_g80 = true;   ///< if false, G80 returns to G0
  /// F must be programmed again after any G93, G94 or G95; if false, only after a change.
  bool feed_mode_ends_feed = false;
  bool feed_before_unit = false;  ///< F in a block with G20 or G21 is read in the unit before the block
  bool tool_change_moves_axes = false;
  bool integer_words_ambiguous = false;  ///< X5 may mean 5 units or 5 increments
  bool g61_is_exact_stop = false;        ///< if false, G61 is exact path
  bool h_and_d_are_modal = false;        ///< H and D are modal words of their own
  bool dwell_takes_axis_words = false;   ///< G4 X1.5 dwells
  bool block_delete_numbers = false;     ///< '/2', and '/' behind N
  bool number_anywhere = true;           ///< N may be anywhere in the block
  bool reference_beside_motion = false;  ///< G0 G28 is allowed; if false, it is an error
  bool macro_words = false;              ///< IF, GOTO, WHILE, and assignments up to the end of the line
  bool k_repeats_holes = false;          ///< K is the count of a cycle; on a Haas it is the least peck
  bool keeps_level = false;              ///< G98 or G99 of the program before still acts
  bool o_words = false;                  ///< o<name> sub, if, while, call
  bool parentheses_nest = false;         ///< if false, a '(' in a comment is an ordinary character
  bool comments_may_stay_open = false;   ///< a comment may end at the end of its line
  bool percent_names = false;            ///< "%O1" or "%PART" at the beginning, ":1" for "O1"
  bool sinumerik_words = false;          ///< X=IC(5), CR=4., R1=5, names, labels; ';' begins comments
  std::string_view radius_name = "R";    ///< of an arc
  RadiusRoom radius_room{0.0283, 2.83};  ///< of a program in mm; measured with LinuxCNC
  RadiusRoom radius_room_inch{0.00283 * 25.4, 0.283 * 25.4};
};

/// Whether P (TURN= of a Sinumerik) is the number of turns of an arc.
constexpr bool arcs_have_turns(const Dialect& dialect) {
  return (dialect.family & (linuxcnc_family | grbl_family | siemens_family)) != 0;
}

/// The name of Heidenhain Klartext, which is not G-code.
inline constexpr std::string_view klartext_name = "heidenhain";

/// The names of robot languages: KUKA KRL, ABB RAPID, URScript of Universal Robots, APT, FANUC TP, Yaskawa
/// INFORM.
inline constexpr std::string_view kuka_name = "kuka", abb_name = "abb", ur_name = "ur", apt_name = "apt",
                                  tp_name = "fanuc_tp", yaskawa_name = "yaskawa";

inline constexpr char comment_open = '(';
inline constexpr char comment_close = ')';

/// The dialect of that name, or nullptr.
const Dialect* find_dialect(std::string_view name);

/// Names for diagnostics, with commas.
std::string dialect_names();

/// Digits after the decimal point of the resolution: 0.001 mm, 0.0001 inch, 0.000001 m.
constexpr int resolution_decimals(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetres:
      return 3;
    case LengthUnit::inches:
      return 4;
    case LengthUnit::metres:
      return 6;
  }
  return 3;
}

/// Converts a length (mm) to its unit.
constexpr double in_unit(double length_mm, LengthUnit unit) {
  return unit == LengthUnit::millimetres ? length_mm : length_mm / mm_per(unit);
}

}  // namespace counterflex
