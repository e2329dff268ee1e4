#pragma once
/// Error tables in the files of volumetric compensation: what a measurement exports and a control reads.
///
/// Both formats are documented by Beckhoff, "TF5280 CNC Volumetric Compensation", and ISG, "Volumetric
/// compensation": lengths in mm, angles of errors in rad, positions of rotary axes in degrees.
#include <map>
#include <string>
#include <string_view>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// `isg`: columns under names ("X EXX EYX ..."), blocks separated by '#'. `etalon`: [EXX] with Gridpoints,
/// the "Vendor" variant. In both '//' begins a comment.
enum class VolcompFormat { isg, etalon };

struct Volcomp {
  std::map<char, ErrorTable> tables;              ///< by axis: X, Y, Z, A, B, C
  std::map<std::string, double> position_errors;  ///< "C0Y": of one axis to another (m or rad)
};

/// Reads `text`; `file` names it in messages. Components of one axis at different positions are interpolated
/// linearly to all of them. `negate`: the file has what a control adds, not the errors. Throws `InputError`
/// (ErrorKind::machine_or_force) at line and column.
Volcomp read_volcomp(std::string_view text, const std::string& file, VolcompFormat format, bool negate);

/// The table of an axis as text of a machine file, [error_tables.x].
std::string table_text(char axis, const ErrorTable& table);

}  // namespace counterflex
