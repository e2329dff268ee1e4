#pragma once
/// Whether the moves of a corrected program are shifted from those of the original as corrections shift them.
#include <array>
#include <optional>

#include "compensation/match/match_moves.hpp"

namespace counterflex {

/// What the moves of a window inherit from those before them (program coordinates, mm).
struct CarriedShifts {
  std::array<std::optional<double>, 3> axes_mm{};  ///< by axis, of the last word in these coordinates
  double height_mm = 0;                            ///< of the last height that is known
};

/// Both programs must set the coordinates of their moves alike, and keep external axes at the same values.
std::optional<Failure> frame_failure(const Job& job, const MatchedMoves& matched);

/// The first failure of move `m`: the heights of a cycle, axes, contours and corners must be shifted alike.
/// Updates `carried`.
std::optional<Failure> shift_failure(const Job& job, std::size_t m, const MatchedMoves& matched,
                                     CarriedShifts& carried);

}  // namespace counterflex
