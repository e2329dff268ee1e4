#pragma once
/// Reads `machine.toml`, format "counterflex-machine 1".
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// The machine that `text` describes. `file` names it in diagnostics. Throws `InputError`
/// (ErrorKind::machine_or_force), with line and column, on bad TOML, a key that the format does not know, a
/// value out of its range, a name that is not defined, or a count of controlled components that is neither
/// zero nor that of the actuators.
Machine read_machine(std::string_view text, const std::string& file);

/// The same, from a file. Throws `InputError` where it cannot be read.
Machine load_machine(const std::string& file);

// A machine in words, for an engineer who wants to know what was understood of a machine file.

/// How many coordinates of each kind a chain has, branches of groups included.
struct Freedoms {
  int actuators = 0;
  int passives = 0;  ///< sprung ones too
  int elastic = 0;   ///< six a spring, one a compliance
};

Freedoms freedoms(const Chain& chain);

/// A page of text, lines ended by "\n": settings, chains with one element a line, springs, actuators with
/// their travel, assembly errors. Lengths in mm, angles in degrees, stiffness in N/m and N m/rad.
std::string describe(const Machine& machine);

/// Unusual, but not wrong, properties, as far as the data show them (no kinematics is solved); one sentence
/// each.
std::vector<std::string> structural_notes(const Machine& machine);

// Tool lengths as LinuxCNC keeps them.

/// Lengths of tools (m) by number. Each line of the table is words `T1 P1 Z50.0 D6`, blank, or a comment
/// after
/// `;`; lengths are Z, in mm, 0 where Z is missing. Throws `InputError` (ErrorKind::machine_or_force) with
/// line and column for words that a table does not have, a line without T, and a tool that it lists twice.
std::map<long, double> read_tool_table(std::string_view text, const std::string& file);

/// Reads a file with an [uncertainty] table alone, "counterflex-uncertainty 1", for `machine`. Throws as
/// `read_machine`.
Uncertainty read_uncertainty(std::string_view text, const std::string& file, const Machine& machine);

}  // namespace counterflex
