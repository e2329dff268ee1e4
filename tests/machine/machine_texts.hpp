#pragma once
/// Short machine files for tests, and access to their parts after reading.
#include <doctest/doctest.h>

#include <string>
#include <variant>

#include "counterflex/machine/read_machine.hpp"

namespace counterflex {

inline const std::string header = "format = \"counterflex-machine 1\"\n";

/// A chain called `name` whose elements are `elements`; `more` are further lines of its table.
inline std::string chain_text(const std::string& elements, const std::string& more = "",
                              const std::string& name = "arm") {
  return "[[chain]]\nname = \"" + name + "\"\n" + more + "elements = [" + elements + "]\n";
}

/// The machine of one chain with these elements; `before` is between header and chain.
inline Machine machine_of(const std::string& elements, const std::string& before = "") {
  return read_machine(header + before + chain_text(elements), "machine.toml");
}

inline const std::string x_axis = "{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 100 }";

/// The machine of a single actuator, with these settings.
inline Machine machine_with(const std::string& settings) {
  return machine_of(x_axis, settings);
}

template <class Part>
const Part& part(const Branch& chain, std::size_t index) {
  REQUIRE(index < chain.elements.size());
  REQUIRE(std::holds_alternative<Part>(chain.elements[index]));
  return std::get<Part>(chain.elements[index]);
}

/// The first element of the only chain, which is given as text.
template <class Part>
Part read_part(const std::string& element) {
  return part<Part>(machine_of(element).chains.at(0), 0);
}

}  // namespace counterflex
