#pragma once
/// Summary of a whole program, gathered window by window. Its size does not grow with the program.
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/boxed_optional.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

struct Overview {
  std::string file;
  std::string dialect;
  std::size_t blocks = 0;      ///< lines with at least one word
  std::size_t moves = 0;       ///< blocks that are moves
  std::size_t bytes = 0;       ///< size of the text
  std::size_t plunges = 0;     ///< feed moves straight down in Z
  std::size_t rapids = 0;      ///< moves that are not feed moves; holes of cycles are rapids
  int text_lines = 0;          ///< number of line ends, plus one if the last line has none
  int lines = 0;               ///< `text_lines`, or the line of the last move if that is larger
  long last_block_number = 0;  ///< the largest N of a move
  std::vector<ProgramFrame> frames{{}};
  /// Line of the first move in the frame, by index into `frames`; 0: none. Before an offset is selected only
  /// moves with a known coordinate count.
  std::vector<int> frame_lines;
  std::vector<long> tools;  ///< in the spindle during a move, each once, ascending; 0: unknown
  std::vector<Remark> remarks;
  std::vector<PathTolerance> path_tolerances;
  Capped<LeftAlone> left_alone;         ///< without the machine positions
  Capped<LeftAlone> machine_positions;  ///< blocks with LeftAlone::machine_position
  std::optional<int> first_force_line;  ///< line of the first move under a FORCE comment other than OFF
  /// Line of the first feed move or hole of a cycle whose tool number is unknown.
  std::optional<int> first_cut_without_tool;
  std::optional<int> first_cycle_line;                         ///< line of the first hole of a cycle
  std::optional<Remark> external_axes_move{};                  ///< as in Program
  std::array<std::optional<ExternalAxis>, 6> external_axes{};  ///< as in Program
  Zones zones{};                                               ///< as in Program
  bool turns_tool = false;                                     ///< whether moves give the tool's orientation
  bool commented_force = false;  ///< whether a move is under a FORCE comment that is not zero
};

/// Adds the next window of a program: whole lines, with line numbers of the file. `block_count`, `frames`,
/// `remarks` and `path_tolerances` of a window count from the program's start and replace the earlier values.
/// `moves`, `text` and `left_alone` belong to the window and are added.
void add_window(Overview& overview, const Program& window);

/// The overview of a program that is one window.
Overview overview_of(const Program& whole);

/// Line of the first call of a program or routine that is not read; empty without one.
std::optional<int> first_unread_call(const Overview& overview);

/// "round 12 targets, largest 10 mm, line 7"; empty without zones.
std::string zones_in_words(const Zones& zones);

// Lengths of the lines of a program, compared with the limit of the control.

struct LineLengths {
  std::size_t limit = 0;    ///< characters of a line that the control reads; 0: no limit is known
  std::size_t longest = 0;  ///< length of the longest line, counted as the control counts it
  int longest_line = 0;
  std::size_t near = 0;  ///< number of lines longer than 90 % of the limit
  int first_near = 0;
  int lines = 0;  ///< number of lines measured so far
};

/// Measures the next lines of a text in `dialect`. Counts nothing for a dialect without a limit. `text` is
/// whole lines; only the last line of the program may lack a line end. Does not allocate.
void add_lines(LineLengths& lengths, std::string_view text, std::string_view dialect);

/// Measures a whole text.
LineLengths line_lengths(std::string_view text, std::string_view dialect);

}  // namespace counterflex
