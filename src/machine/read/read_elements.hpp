#pragma once
/// Lists of elements, expanded for one chain.
#include <set>

#include "machine/read/library.hpp"

namespace counterflex::toml_file {

/// State of the expansion of one chain: the definitions that it uses, and the slots and branches found so
/// far.
struct Expansion {
  const Source& source;
  Library& library;
  Fillings& fillings;
  std::set<std::string> slots;             ///< error slots found
  std::vector<std::string> open_branches;  ///< the branches that are being read, outermost first
  std::size_t coordinates = 0;             ///< of the chain so far, see `read_elements`
};

/// Counts equations of the static system: 6 for each closure of a chain or branch. Throws at `node` if a
/// machine has too many.
void count_coordinates(std::size_t count, const toml::node& node, Expansion& expansion);

/// The elements listed by `node`, branches of groups included. Throws at unknown names, a branch inside
/// itself or more than 8 deep, a repeated error slot, more than 10000 elements in a machine (branches that
/// use branches multiply), more than 180 coordinates in a chain or 360 in a machine.
std::vector<Element> read_elements(const toml::node& node, Expansion& expansion);

}  // namespace counterflex::toml_file
