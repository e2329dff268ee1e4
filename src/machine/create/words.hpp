#pragma once
/// Pieces of machine files.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::made {

/// At most 15 significant digits.
std::string number(double value);

/// "[1, 2, 3]".
std::string triple(const Vector3& v);

/// "quat_wxyz = [1, 0, 0, 0]".
std::string turned(const Matrix3& R);

/// A number's deviation in the words of [parameters], and its source.
struct Knowledge {
  std::string deviation;  ///< "sigma = 0.3"
  NumberSource source = NumberSource::prior;
  std::string note;
};
std::string sigma(double value);    ///< in the unit of the parameter's name
std::string percent(double value);  ///< "prior_percent = 50"

/// The line of [parameters] for one number, ended by "\n".
std::string stated(std::string_view parameter, const Knowledge& knowledge);

/// The lines for some components, "x_mm" to "rz_deg", of an error slot.
std::string stated_errors(std::string_view slot, const std::vector<std::string_view>& components,
                          const Knowledge& position, const Knowledge& orientation);

/// The first lines of a file: who made it, the format, name and controlled components.
struct Title {
  std::string command;  ///< "counterflex new mill3"
  std::string what;     ///< sentences; broken into comment lines here
  std::string name;
  std::string controlled;  ///< `"x", "y", "z"`
};
std::string title(const Title& title);

/// The comment above [parameters] and its header.
std::string parameters_header();

/// [work.NAME] at a place (mm), with the comment on its datum.
std::string work_offset(std::string_view name, const Vector3& at_mm);

/// `text` as comment lines of at most 120 columns.
std::string comment(std::string_view text);

/// The travel of an axis: as the facts have it, or `otherwise`.
AxisRange travel_of(const MachineFacts& facts, char axis, AxisRange otherwise);

// The kinds.
std::string mill_file(const MachineFacts& facts);
std::string robot_file(const MachineFacts& facts);
std::string hexapod_file(const MachineFacts& facts);
std::string delta_file(const MachineFacts& facts);
std::string orthoglide_file(const MachineFacts& facts);

}  // namespace counterflex::made
