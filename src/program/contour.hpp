#pragma once
/// Contours under G41 and G42: runs of moves that are shifted together.
#include "program/interpret.hpp"

namespace counterflex {

/// What G40, G41 and G42 of the block begin and end; before its move is read.
void apply_cutter(Reading& reading);

/// Puts the move just read into the contour that it belongs to.
void join_contour(Reading& reading);

/// No further move belongs to the contour.
void end_contour(Reading& reading);

}  // namespace counterflex
