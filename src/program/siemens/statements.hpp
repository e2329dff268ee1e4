#pragma once
/// What a Sinumerik's lines say besides words: frames, calls, transformations.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// States that hold for the words of the block already.
void begin_statement(const Block& block, Reading& reading);

/// Whether the words of the block are read as a move; else they belong to the statement.
bool has_words_of_its_own(const Block& block, const Reading& reading);

/// What the statement does after them.
void end_statement(const Block& block, Reading& reading);

/// The block, whose words count otherwise than the modal state has it: sets `reading.block_relative`, and
/// `reading.relative_axes` where some count from the start and some do not. Of an arc those are marked as not known.
Block with_senses(const Block& block, Reading& reading);

/// D: the tool's edge, whose length shifts Z; a tool change selects the first.
void apply_tool_edge(Reading& reading);

}  // namespace counterflex
