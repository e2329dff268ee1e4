#pragma once
/// Where a program has said its position last.
#include <array>
#include <optional>
#include <string>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {

/// By program axis the byte at which the block of the last move begins that says it, of those before byte
/// `end`; nothing where none does. `bytes` are read as by a ProgramReader, and no further than that; where a
/// window cannot be read, it is what has been found before it.
std::array<std::optional<std::size_t>, 3> last_words_before(std::size_t end, FileReader& bytes,
                                                            const std::string& file,
                                                            const ReadOptions& options);

}  // namespace counterflex
