#pragma once
/// The parts of reading that all kinds of moves share.
#include <string>

#include "program/gcode/interpret.hpp"

namespace counterflex {

inline constexpr std::array<char, 3> letters_of_axes{'X', 'Y', 'Z'};

/// The first word of X, Y or Z in the block, else its first word.
const Word& first_axis_word(const Block& block);

bool has_axis_word(const SortedBlock& sorted);

/// Whether A, B and C are the tool's orientation.
bool may_turn_tool(const Reading& reading);

/// Refuses drilling cycles and cutter compensation in a program that turns the tool.
void refuse_beside_orientation(const Block& block, const Reading& reading);

/// The feed that acts now (mm/min); 0 if it is unknown.
double feed_mm_min(const Reading& reading);

/// Whether the tool's orientation is known, or no word turns it.
bool has_known_orientation(const ModalState& state);

/// Why moves cannot be followed now: a condition, a displacement, an unknown state. Empty if they can.
std::string_view why_not_followed(const Reading& reading);

/// Adds a move to the program that begins at the tool's position, with the modal states.
Move& begin_move(const Block& block, Reading& reading, Motion motion);

/// The same with the other words of the block, in place of another move of the block.
Move& start_move(const Block& block, Reading& reading, Motion motion);

/// Reads X, Y and Z of the block into the move and the state. A word that cannot be followed makes its axis
/// fixed and unknown.
void place_words(const Block& block, Reading& reading, Move& move);

/// The machine moves the axis by itself: its position is unknown.
void move_by_machine(Reading& reading, std::size_t axis);

/// The block moves the axis to a position that is not known from the program.
void fix_axis(Reading& reading, Move& move, std::size_t axis);

/// Splines, pockets, arcs without a known centre: the tool reaches the end on a way that is not followed.
void forget_way(Move& move);

/// Sets what may be changed of a move read by `takes_plain_lines`, with the result of `finish_move`.
void allow_plain_changes(const Reading& reading, Move& move);

/// Sets the end of the move, and what may be changed.
void finish_move(Reading& reading, Move& move);

/// `word` as a length (mm).
double length_mm(const Reading& reading, const Word& word);

/// Adds an uncorrected block. Of a run of blocks with the same reason only the first is added.
void note_uncorrected(const Block& block, Reading& reading, std::string_view why);

/// Refuses the block at `word` or, if that is null, at its begin.
[[noreturn]] void refuse_word(const Block& block, const Reading& reading, const Word& word,
                              const std::string& message);

/// Refuses the block at the length `word` if its unit is unknown.
void demand_unit(const Block& block, const Reading& reading, const Word& word);

inline double& coordinate(Vector3& v, std::size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

}  // namespace counterflex
