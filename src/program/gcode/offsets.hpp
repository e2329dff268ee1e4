#pragma once
/// Work offsets, tool lengths, and states that put programmed positions elsewhere.
#include "program/gcode/interpret.hpp"

namespace counterflex {

void apply_work_offset(const Block& block, Reading& reading);

/// A change of the length shifts Z of the program while the machine stands still: by the difference where
/// both lengths are known, else Z is unknown.
void apply_tool_length(const Block& block, Reading& reading);

/// G52, G68, G51, G16, G66, G92, tool centre point control, and other axes.
void apply_displacements(const Block& block, Reading& reading);

/// A, B, C, U, V, W: those that stay zero are nothing, the first other one displaces all that follows.
void watch_other_axes(const Block& block, Reading& reading);

/// G10.
void apply_set_data(const Block& block, Reading& reading);

/// Whether axis words of the block belong to such a code, so that it does not move.
bool takes_axis_words(const Reading& reading);

}  // namespace counterflex
