#pragma once
/// What a block of G-code sets and does, as far as a restart behind it depends on it.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "program/dialect.hpp"
#include "program/gcode/words/codes.hpp"
#include "program/text/lex.hpp"

namespace counterflex::restart {

/// States that a program sets, and axes whose positions it gives. Axes come last.
enum Item : std::uint8_t {
  of_unit,
  of_distance,
  of_plane,
  of_offset,
  of_cutter,
  of_path,
  of_centres,
  of_motion,
  of_feed_mode,
  of_spindle_mode,
  of_tool_length,
  of_retract,
  of_feed,
  of_speed,
  of_spindle,
  of_mist,
  of_flood,
  of_axis
};

inline constexpr std::string_view axes = "XYZABCUVW";
inline constexpr std::size_t items = of_axis + axes.size();

/// A word that sets a state, and its line.
struct Given {
  std::string word;
  int line = 0;
};

using States = std::array<std::optional<Given>, items>;

/// What a block sets and does.
struct Effects {
  States set{};
  std::map<int, std::string> codes{};  ///< states without a group, by number
  std::string carries{};               ///< the word whose effect on later blocks is not followed
  std::string why_none{};              ///< why no line of the program is proven
  std::array<bool, axes.size()> positions{};
  std::optional<long> tool{};
  bool changes_tool = false, only_chooses = true, ends = false;
  bool has_data = false;                      ///< words of axes are not positions
  bool has_axis = false, has_centre = false;  ///< words of axes, of arcs
  bool is_machine = false;                    ///< they are positions of the machine
  bool cuts_by_itself = false;                ///< a cycle of the control
  bool has_hole = true;                       ///< the words that a drilling cycle needs
  std::optional<Action> motion{};
};

struct BlockText {
  std::string_view text;
  const Dialect& dialect;
};

Effects effects_of(const Block& block, const BlockText& in);

}  // namespace counterflex::restart
