#pragma once
/// Statements of a Sinumerik: frames, calls, transformations.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Stores the names that DEF and PROC declare.
void note_declarations(const Block& block, Reading& r);

/// Whether the block assigns a value to a name that is not a variable. It may move axes.
bool assigns_to_word(const Block& block, const Reading& r);

/// States that already apply to the words of the block.
void begin_statement(const Block& block, Reading& reading);

/// Whether the words of the block are read as a move; else they belong to the statement.
bool has_words_of_its_own(const Block& block, const Reading& reading);

/// Effects of the statement after the words.
void end_statement(const Block& block, Reading& reading);

/// For a block whose words have other modes than the modal state: sets `reading.block_relative`, and
/// `reading.relative_axes` if only some words are differences.
void apply_own_modes(const Block& block, Reading& reading);

/// D: the tool's edge, whose length shifts Z. A tool change selects the first edge.
void apply_tool_edge(Reading& reading);

}  // namespace counterflex
