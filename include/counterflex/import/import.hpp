#pragma once
/// Machine files from other descriptions of a machine. Each function returns the text of a machine file in
/// the format "counterflex-machine 1", which `read_machine` reads; its nominal kinematics is that of the
/// source.
///
/// Every joint gets an error slot and a compliance. A number that the source does not state is a placeholder:
/// a comment "# PLACEHOLDER: ..." and, in [parameters], the source "prior".
///
/// `file` names the source in diagnostics and comments. All functions throw `InputError`
/// (ErrorKind::machine_or_force), with line and column, for text that they cannot read.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// The first line of every imported machine file begins with it.
inline constexpr std::string_view import_mark = "# counterflex import ";

enum class DhConvention {
  standard,  ///< Rz(theta) Tz(d) Tx(a) Rx(alpha)
  modified,  ///< Rx(alpha) Tx(a) Rz(theta) Tz(d), of Craig: alpha and a are those of the link before the
             ///< joint
};

/// A table of Denavit-Hartenberg parameters (CSV, one row per joint). Required columns: a, d (_mm or _m),
/// alpha, theta
/// (_deg or _rad). Optional: joint (a name), type (revolute or prismatic), min, max, home (_deg, _rad, _mm or
/// _m). The joint value is added to theta, of a prismatic joint to d.
std::string import_dh(std::string_view text, const std::string& file, DhConvention convention);

/// The kinematic calibration of a Universal Robots arm as its ROS driver writes it (YAML): for each joint
/// from `shoulder` to `wrist_3` the pose of its link in the link before, x y z (m) and roll pitch yaw (rad).
/// M is the control's base frame, P its flange.
std::string import_ur_calibration(std::string_view text, const std::string& file);

/// The joints of a URDF from the link `base`, which becomes M, to the link `tip`, which becomes P. An empty
/// `base` is the root, an empty `tip` the only link without children. Masses are those of the links'
/// inertials; links that are fixed to one of the path count, others do not. xacro must be expanded.
std::string import_urdf(std::string_view text, const std::string& file, const std::string& base,
                        const std::string& tip);

/// A file of LinuxCNC's configuration.
struct ConfigurationFile {
  std::string name;
  std::string text;
};

/// The names of the HAL files that an INI file of LinuxCNC loads ([HAL] HALFILE, .hal only, none of
/// LinuxCNC's library), as it has them.
std::vector<std::string> hal_files_of(const ConfigurationFile& ini);

/// The kinematics of a LinuxCNC configuration: `genserkins` and `genhexkins` from the pins that HAL files
/// set, `trivkins` from the limits of an INI file. `files` is one INI file (its name ends in .ini) and the
/// HAL files that it loads, or HAL files alone; then the unit of lengths is taken to be mm.
std::string import_linuxcnc(const std::vector<ConfigurationFile>& files);

}  // namespace counterflex
