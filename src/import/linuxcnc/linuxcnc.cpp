#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/import/import.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/program/read_program.hpp"
#include "import/linuxcnc/configuration.hpp"
#include "import/linuxcnc/kinematics.hpp"
#include "import/toml_text.hpp"

namespace counterflex {
namespace import {
namespace {

double unit_of_length(const IniValues& ini) {
  const PlacedText* unit = ini.find("TRAJ", "LINEAR_UNITS");
  if (unit == nullptr)
    fail({ini.file, 1, 1},
         "the file has no LINEAR_UNITS in [TRAJ]; the unit of its lengths is not known. Add: LINEAR_UNITS = "
         "mm");
  if (unit->text == "mm" || unit->text == "metric") return mm;
  if (unit->text == "inch" || unit->text == "in" || unit->text == "imperial") return inch;
  fail(unit->at, fmt::format("LINEAR_UNITS is '{}'; it must be mm or inch", without_controls(unit->text)));
}

void refuse_other_angles(const IniValues& ini) {
  const PlacedText* unit = ini.find("TRAJ", "ANGULAR_UNITS");
  if (unit != nullptr && unit->text != "deg" && unit->text != "degree" && unit->text != "degrees")
    fail(unit->at,
         fmt::format("ANGULAR_UNITS is '{}'; only degree is imported", without_controls(unit->text)));
}

/// The module that [KINS] KINEMATICS names, or whose pins are set.
PlacedText module_of(const LinuxCnc& source) {
  const PlacedText* named = source.ini == nullptr ? nullptr : source.ini->find("KINS", "KINEMATICS");
  if (named != nullptr) return {named->text.substr(0, named->text.find_first_of(" \t")), named->at};
  if (source.ini != nullptr)
    fail({source.file, 1, 1}, "the file has no KINEMATICS in [KINS], so the kind of machine is not known");
  if (source.pins.empty())
    fail({source.file, 1, 1},
         "no line sets a pin of genserkins or genhexkins; import the HAL file that does, or the INI file");
  const auto& [name, pin] = *source.pins.begin();
  return {name.substr(0, name.find('.')), pin.at};
}

}  // namespace

std::string machine_name(const LinuxCnc& source) {
  const PlacedText* name = source.ini == nullptr ? nullptr : source.ini->find("EMC", "MACHINE");
  return name == nullptr || name->text.empty() ? file_stem(source.file) : name->text;
}

namespace {

/// The unit after the startup code, before which it is `unit`: that of a move behind it. None if the code is
/// not read, if it calls a program, or if the move's place is not known.
std::optional<LengthUnit> unit_after(const PlacedText& startup, LengthUnit unit) {
  ReadOptions options;
  options.dialect = "linuxcnc";
  options.unit = unit;
  try {
    const Program program = read_program(startup.text + "\nG90 G0 X1\n", startup.at.file, options);
    const bool is_reached = !program.moves.empty() && program.moves.back().line == 2;
    if (!is_reached || !program.moves.back().known_end[0] || first_unread_call(overview_of(program)))
      return std::nullopt;
    return program.moves.back().unit;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::string program_units(const LinuxCnc& source) {
  if (source.ini == nullptr) return "";
  const LengthUnit unit = source.length == inch ? LengthUnit::inches : LengthUnit::millimetres;
  const PlacedText* startup = source.ini->find("RS274NGC", "RS274NGC_STARTUP_CODE");
  if (startup != nullptr && unit_after(*startup, unit) != unit) return "";
  return unit == LengthUnit::inches ? "inch" : "mm";
}

}  // namespace import

std::vector<std::string> hal_files_of(const ConfigurationFile& ini) {
  const import::IniValues values = import::read_ini(ini);
  std::vector<std::string> files;
  const auto section = values.sections.find("HAL");
  if (section == values.sections.end()) return files;
  const auto names = section->second.find("HALFILE");
  if (names == section->second.end()) return files;
  for (const import::PlacedText& name : names->second) {
    const std::string file = name.text.substr(0, name.text.find_first_of(" \t"));
    if (file.ends_with(".hal") && !file.starts_with("LIB:")) files.push_back(file);
  }
  return files;
}

std::string import_linuxcnc(const std::vector<ConfigurationFile>& files) {
  using namespace import;
  const auto is_ini = [](const ConfigurationFile& file) { return file.name.ends_with(".ini"); };
  const auto found = std::find_if(files.begin(), files.end(), is_ini);
  std::optional<IniValues> ini;
  if (found != files.end()) ini = read_ini(*found);
  LinuxCnc source;
  source.file = found != files.end() ? found->name : files.front().name;
  source.ini = ini ? &*ini : nullptr;
  if (ini) {
    source.length = unit_of_length(*ini);
    refuse_other_angles(*ini);
  }
  source.pins = read_pins(files, source.ini);
  const PlacedText module = module_of(source);
  if (module.text == "genserkins") return genserkins_machine(source);
  if (module.text == "genhexkins") return genhexkins_machine(source);
  if (module.text == "trivkins") return trivkins_machine(source);
  fail(
      module.at,
      fmt::format(
          "the kinematics {} is not imported; allowed are genserkins, genhexkins and trivkins. An arm can be "
          "imported from its Denavit-Hartenberg parameters with `import dh`",
          without_controls(module.text)));
}

}  // namespace counterflex
