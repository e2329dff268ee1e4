#pragma once
/// Labels of Klartext, and the stretches of a program that jumps and repetitions put in doubt.
#include <string_view>
#include <vector>

namespace counterflex {

/// Lines from `first` to `last`, both included.
struct LineStretch {
  int first = 0;
  int last = 0;
};

/// The stretches whose blocks may be run often or not at all: bodies of subprograms that are called, parts
/// that are repeated, and what a jump passes over. In order and apart.
std::vector<LineStretch> doubtful_stretches(std::string_view text);

bool holds(const std::vector<LineStretch>& stretches, int line);

/// Lines of the CC whose pole other blocks use than C, so that it cannot be moved with the arcs about it; not
/// of one that a single CP alone uses. In order.
std::vector<int> poles_used_otherwise(std::string_view text);

}  // namespace counterflex
