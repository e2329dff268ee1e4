#pragma once
/// The machine files of LinuxCNC's kinematics modules.
#include <string>

#include "import/linuxcnc/configuration.hpp"

namespace counterflex::import {

struct LinuxCnc {
  std::string file;                ///< for diagnostics and comments
  const IniValues* ini = nullptr;  ///< may be missing
  HalPins pins;
  double length = 1e-3;  ///< m per unit of length
};

std::string machine_name(const LinuxCnc& source);

/// Of [program]: the unit of length that the INI file states, "mm" or "inch". Empty without an INI file, and
/// if its startup code sets the other unit or is not understood.
std::string program_units(const LinuxCnc& source);

/// `genserkins`: six rotary joints with modified Denavit-Hartenberg parameters. `unrotate` couples a joint
/// with the one before it.
std::string genserkins_machine(const LinuxCnc& source);

/// `genhexkins`: six struts, whose lengths are the joint values.
std::string genhexkins_machine(const LinuxCnc& source);

/// `trivkins`: the linear axes of an INI file.
std::string trivkins_machine(const LinuxCnc& source);

}  // namespace counterflex::import
