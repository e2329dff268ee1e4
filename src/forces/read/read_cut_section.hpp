#pragma once
/// One section of a file of cutting models.
#include "counterflex/forces/cutting_model.hpp"
#include "forces/read/read_coefficients.hpp"

namespace counterflex::force_file {

struct Cutter {
  EndMill mill;
  bool mills = true;  ///< has a helix angle
};

using Cutters = std::map<std::string, Cutter, std::less<>>;

/// Definitions that sections refer to.
struct CutLibrary {
  Cutters cutters;
  Materials materials;
  ForceAt force_at = ForceAt::mean;  ///< of sections without this key
};

/// The table `cutters`.
Cutters read_cutters(const toml::table& document, const toml_file::Source& source);

/// "mean" or "surface".
ForceAt read_force_at(const toml::node& node, const toml_file::Source& source);

/// The section with this number in its file, counted from 1.
CutSection read_cut_section(const toml::node& node, std::size_t number, const CutLibrary& library,
                            const toml_file::Source& source);

}  // namespace counterflex::force_file
