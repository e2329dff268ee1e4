#pragma once
/// The parts of a machine file that are not its chains.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// `serial` and `date`.
void read_identity(const toml::table& document, const Source& source, Machine& machine);

/// Each reads the optional table or key of its name from the document into `machine`.
void read_controlled(const toml::table& document, const Source& source, Machine& machine);
void read_home(const toml::table& document, const Source& source, Machine& machine);
void read_gravity(const toml::table& document, const Source& source, Machine& machine);
void read_tool(const toml::table& document, const Source& source, Machine& machine);
void read_spindle(const toml::table& document, const Source& source, Machine& machine);
void read_work(const toml::table& document, const Source& source, Machine& machine);
void read_program(const toml::table& document, const Source& source, Machine& machine);
void read_controller(const toml::table& document, const Source& source, Machine& machine);
void read_limits(const toml::table& document, const Source& source, Machine& machine);

}  // namespace counterflex::toml_file
