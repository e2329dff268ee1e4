#pragma once
/// Lists of elements, expanded for one chain.
#include <set>

#include "library.hpp"

namespace counterflex::toml_file {

/// The expansion of one chain: what its lists draw on, and what has been met so far.
struct Expansion {
  const Source& source;
  Library& library;
  Fillings& fillings;
  std::set<std::string> slots;             ///< error slots met
  std::vector<std::string> open_branches;  ///< branches inside which the reader is, outermost first
  std::size_t coordinates = 0;             ///< of the chain so far, see `read_elements`
};

/// Equations of the static system: 6 for each closure of a chain or branch. Throws at `node` where a machine has too many.
void count_coordinates(std::size_t count, const toml::node& node, Expansion& expansion);


/// The elements listed by `node`, branches of groups included. Throws at unknown names, a branch inside
/// itself or more than 8 deep, an error slot met twice, more than 10000 elements in a machine (branches that
/// use branches multiply), more than 180 coordinates in a chain or 360 in a machine.
std::vector<Element> read_elements(const toml::node& node, Expansion& expansion);

}  // namespace counterflex::toml_file
