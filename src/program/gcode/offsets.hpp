#pragma once
/// Work offsets, tool lengths, and states that displace programmed positions.
#include "program/gcode/interpret.hpp"

namespace counterflex {

void apply_work_offset(const Block& block, Reading& reading);

/// Reads the tool length: G43, G44, G49, and on shop controls H alone while one acts. A change of the length
/// shifts Z of the program while the machine does not move. Z stays known if both lengths are known; else it
/// becomes unknown.
void apply_tool_length(const Block& block, Reading& reading);

/// G52, G68, G51, G16, G66, G92, tool centre point control, and other axes.
void apply_displacements(const Block& block, Reading& reading);

/// A, B, C, U, V, W: words of axes that stay at zero are ignored. The first other word displaces all
/// following moves.
void watch_other_axes(const Block& block, Reading& reading);

/// A statement has set the work offset in a way that is not followed. Empty: any of them, or coordinates that
/// no work offset resets.
void note_offset_set(Reading& reading, std::string_view name);

/// G10.
void apply_set_data(const Block& block, Reading& reading);

/// Variables of the control that the block assigns: offsets and tool lengths are unknown behind them.
void apply_variables(const Block& block, Reading& reading);

/// N1221 R5 between G10 L50 and G11: a parameter of a work offset.
void apply_parameter(const Block& block, Reading& reading);

/// Whether axis words of the block belong to such a code, so that the block does not move the tool.
bool takes_axis_words(const Reading& reading);

/// Whether a code that ends a displacement ends it for X, Y and Z. G92.1 X0 and G50.1 X0 end that of X only.
bool ends_all_axes(const Reading& reading, const GCode& code);

}  // namespace counterflex
