#pragma once
/// The subprograms that stand in a text.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/expand/control_flow.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// How a subprogram is named: by its O-number, by the number of its first block (M97), by an O-word.
enum class NameKind { program, block, word };

struct SubprogramName {
  NameKind kind = NameKind::program;
  std::string name;  ///< digits without leading zeros, or <name> in lower case without blanks
  auto operator<=>(const SubprogramName&) const = default;
};

struct Definition {
  LinePlace begin;             ///< its O line
  LinePlace body;              ///< the line behind; of a block number the same line
  bool ends = false;           ///< by M99 or endsub, before the program does
  LinePlace end;               ///< then this line
  LinePlace after;             ///< and the one behind
  ControlFlow flow;            ///< of its body
  std::string why_not;         ///< its body cannot be copied
  bool seeks_numbers = false;  ///< M99 with P
};

/// By name. Two with the same name say nothing.
using Definitions = std::map<SubprogramName, std::vector<LinePlace>>;

/// Lines that define a subprogram or may, up to the '%' that ends the file. Numbers of programs that stand
/// before the end of a LinuxCNC's program are the program's own.
Definitions find_definitions(std::string_view text, const std::string& file, const Dialect& dialect);

/// Whether the line is G-code: what stands behind the end of a program need not be.
bool lexes(std::string_view text, const std::string& file, const Dialect& dialect, Block& block);

/// Reads the body that begins at `begin`. Throws `InputError` for what is no G-code.
Definition read_definition(std::string_view text, const std::string& file, const Dialect& dialect,
                           const SubprogramName& name, LinePlace begin);

/// A Block before the line at `place`.
Block before(LinePlace place);

/// M with that number, or nullptr.
const Word* find_m(const Block& block, int code);
const Word* find_letter(const Block& block, char letter);

/// Whether M2 or M30 stands in it.
bool ends_program(const Block& block);

/// "100" of "0100", "<pocket>" of "< Pocket >"; empty where it is an expression.
std::string normal_name(std::string_view name);

}  // namespace counterflex
