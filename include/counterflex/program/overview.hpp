#pragma once
/// What a whole program holds, in memory that does not grow with it: gathered window by window.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/program/capped.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

struct Overview {
  std::string file;
  std::string dialect;
  std::size_t blocks = 0;      ///< lines with a word
  std::size_t moves = 0;       ///< of these, moves
  std::size_t bytes = 0;       ///< of the text
  std::size_t plunges = 0;     ///< feed moves straight down in Z
  std::size_t rapids = 0;      ///< moves that are no feed moves: holes of cycles, too
  int text_lines = 0;          ///< line ends, and a last line that has none
  int lines = 0;               ///< `text_lines`, or the line of the last move where that is more
  long last_block_number = 0;  ///< the largest N of a move
  std::vector<ProgramFrame> frames{{}};
  std::vector<bool> frames_used;  ///< by a move; by index into `frames`
  std::vector<long> tools;         ///< in the spindle for a move, each once, ascending; 0: none known
  std::vector<Remark> remarks;
  std::vector<PathTolerance> path_tolerances;
  Capped<LeftAlone> left_alone;
  std::optional<int> first_force_line;  ///< of the first move under a FORCE comment that is not OFF
  std::optional<int>
      first_feed_without_tool;          ///< line of the first feed move with no tool whose number is known
  std::optional<int> first_cycle_line;  ///< of the first hole of a cycle
  bool commented_force = false;         ///< a move is under a FORCE comment that is not zero
};

/// Adds the next window of a program: whole lines, with line numbers of the file. What a window counts and
/// lists from the program's start (`block_count`, `frames`, `remarks`, `path_tolerances`) is taken as
/// it is; `moves`, `text` and `left_alone` are the window's own.
void add_window(Overview& overview, const Program& window);

/// Of a program that is one window.
Overview overview_of(const Program& whole);

}  // namespace counterflex
