#pragma once
/// Subprograms that are defined in a text.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/expand/control_flow.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// Name of a subprogram: its O-number, the number of its first block (M97), or its O-word.
enum class NameKind { program, block, word };

struct SubprogramName {
  NameKind kind = NameKind::program;
  std::string name;  ///< digits without leading zeros, or <name> in lower case without blanks
  auto operator<=>(const SubprogramName&) const = default;
};

struct Definition {
  LinePlace begin;             ///< its O line
  LinePlace body;              ///< the line behind it; of a block number the same line
  bool ends = false;           ///< by M99 or endsub, before the end of the program
  LinePlace end;               ///< the line that ends it, if `ends`
  LinePlace after;             ///< the line behind `end`
  ControlFlow flow;            ///< of its body
  std::string why_not;         ///< why its body cannot be copied; empty: it can
  bool seeks_numbers = false;  ///< M99 with P
};

/// By name. Two definitions with the same name are ambiguous.
using Definitions = std::map<SubprogramName, std::vector<LinePlace>>;

/// Lines that define a subprogram or may define one, up to the '%' that ends the file. In LinuxCNC, numbers
/// before the end of the program belong to the program itself.
Definitions find_definitions(std::string_view text, const std::string& file, const Dialect& dialect);

/// Whether the line is G-code. Text behind the end of a program need not be.
bool lexes(std::string_view text, const std::string& file, const Dialect& dialect, Block& block);

/// Reads the body that begins at `begin`. Throws `InputError` for text that is not G-code.
Definition read_definition(std::string_view text, const std::string& file, const Dialect& dialect,
                           const SubprogramName& name, LinePlace begin);

/// A block before the line at `place`.
Block before(LinePlace place);

/// The word M with that number, or nullptr.
const Word* find_m(const Block& block, int code);
const Word* find_letter(const Block& block, char letter);

/// Whether the block has M2 or M30.
bool ends_program(const Block& block);

/// "100" of "0100", "<pocket>" of "< Pocket >"; empty for an expression.
std::string normal_name(std::string_view name);

}  // namespace counterflex
