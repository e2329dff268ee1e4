#pragma once
/// The parts of which every kind of move is put together.
#include <string>

#include "program/gcode/interpret.hpp"

namespace counterflex {

inline constexpr std::array<char, 3> letters_of_axes{'X', 'Y', 'Z'};

/// The first word of X, Y or Z in the block, else its first word.
const Word& first_axis_word(const Block& block);

bool has_axis_word(const SortedBlock& sorted);

/// Why no move can be followed now, or empty: a condition, a state that puts positions elsewhere, a state
/// that is in doubt.
std::string_view why_not_followed(const Reading& reading);

/// Adds a move to the program that begins where the tool is, with what is modal alone.
Move& begin_move(const Block& block, Reading& reading, Motion motion);

/// The same with what the block says besides its places, in place of another move of the block.
Move& start_move(const Block& block, Reading& reading, Motion motion);

/// Takes the block's X, Y and Z into the move and the state; those that cannot be followed are fixed, their
/// axes unknown.
void place_words(const Block& block, Reading& reading, Move& move);

/// The machine moves the axis by itself: nobody knows where to.
void take_away(Reading& reading, std::size_t axis);

/// The axis goes to a place of the block's own which the program does not show.
void fix_axis(Reading& reading, Move& move, std::size_t axis);

/// Decides what may be changed of a move that `takes_plain_lines` lets be read, as `finish_move` does.
void allow_plain_changes(Move& move);

/// Sets the end, and decides what may be changed.
void finish_move(Reading& reading, Move& move);

/// `word` as a length (mm).
double length_mm(const Reading& reading, const Word& word);

/// Notes a block that is not corrected; one for a run of blocks with the same reason.
void leave_alone(const Block& block, Reading& reading, std::string_view why);

/// Refuses the block at `word` or, where it has none, at its begin.
[[noreturn]] void refuse_word(const Block& block, const Reading& reading, const Word& word,
                              const std::string& message);

/// Refuses the block at `word`, a length, where no unit is known for it.
void demand_unit(const Block& block, const Reading& reading, const Word& word);

inline double& coordinate(Vector3& v, std::size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

}  // namespace counterflex
