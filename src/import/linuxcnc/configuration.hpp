#pragma once
/// INI and HAL files of LinuxCNC with the places of their values.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/import/import.hpp"

namespace counterflex::import {

struct PlacedText {
  std::string text;
  Location at;
};

/// [SECTION] KEY = VALUE; of a key that is repeated in a section the first value counts, as for LinuxCNC.
struct IniValues {
  std::string file;
  std::map<std::string, std::map<std::string, std::vector<PlacedText>>> sections;

  const PlacedText* find(const std::string& section, const std::string& key) const;
  /// A finite number, without what is behind a blank; none if the key is missing. Throws for other text.
  std::optional<double> number(const std::string& section, const std::string& key) const;
};

IniValues read_ini(const ConfigurationFile& ini);

/// A pin of a kinematics module: the value that `setp` gives it, or the signal that `net` connects it with.
struct HalPin {
  std::string value;  ///< empty: connected
  Location at;
};

/// By name. Only the pins of `genserkins` and `genhexkins`.
using HalPins = std::map<std::string, HalPin>;

/// The pins of all HAL files among `files`; values that refer to the INI file are looked up there. Throws
/// `InputError` for a pin that is set twice.
HalPins read_pins(const std::vector<ConfigurationFile>& files, const IniValues* ini);

/// The value of a pin. Throws if it is missing, connected with a signal, or not a finite number. `file` is
/// where a missing pin is reported.
double pin_value(const HalPins& pins, const std::string& name, const std::string& file);

/// Refuses pins that begin with "MODULE." and are not in `known`.
void refuse_unknown_pins(const HalPins& pins, const std::vector<std::string>& known);

struct Travel {
  std::optional<double> min, max;  ///< m or rad
};

/// MIN_LIMIT and MAX_LIMIT of [JOINT_n], in units of `unit`; none without an INI file.
Travel travel_of_joint(const IniValues* ini, std::size_t joint, double unit);

}  // namespace counterflex::import
