#pragma once
/// Reads a machining program.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

struct ReadOptions {
  std::string dialect = "auto";           ///< auto, linuxcnc, ... ; auto: an O-number means fanuc, else linuxcnc
  std::optional<LengthUnit> unit;         ///< where the program does not say before its first move
  std::vector<char> tool_change_moves = {'X', 'Y', 'Z'};  ///< axes unknown after a tool change
};

/// Reads `text`, keeping every byte. `file` names it in diagnostics. Throws `InputError` (Exit::program_text) with line
/// and column for text that is wrong and for words that are not understood yet: nothing is passed over.
Program read_program(std::string text, const std::string& file, const ReadOptions& options);

/// Whether the header of a corrected program stands in `text` (a comment that begins "COUNTERFLEX 1").
bool is_corrected(const Program& program);

}  // namespace counterflex
