#pragma once
/// Reading cutting models, and the coefficients that the tool brings along.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/forces/force_rule.hpp"

namespace counterflex {

/// What a file says of a part of the program: which, and how it is cut.
struct CutSection {
  std::string name;  ///< `section 1`, counted from 1, unless the file gives one
  Location where;
  ForceSelector selector;
  CuttingModel model;
};

/// Reads a TOML file of cutting models (format = "counterflex-forces 1"):
///
///     force_at = "mean" | "surface"      for all sections that do not say it; "mean" unless given
///     [cutters.NAME]                     diameter_mm, flutes, helix_deg (0 to 60)
///     [materials.NAME]                   Ktc_N_mm2 and Krc_N_mm2; Kac_N_mm2, Kte_N_mm, Kre_N_mm, Kae_N_mm, 0
///                                        unless given; before the names of `published_coefficients`
///     [[section]]                        in any number:
///       name                             for messages
///       tool = "T3", op = "POCKET*", lines = [10, 200], blocks = [10, 90]
///                                        which moves: those that meet all that is given
///       cutter, material                 names
///       axial_depth_mm
///       radial_depth_mm, side = "up" | "down"; or side = "slot"; or entry_deg and exit_deg (0 to 180)
///       spindle_rpm                      instead of the program's S
///       force_at
///
/// A radial depth a_e enters at 0 and leaves at acos(1 - 2 a_e / D) in up milling, enters at pi less that and
/// leaves at pi in down milling; a slot is cut from 0 to pi. The wall that `surface` asks for stands at the
/// entry in up milling, at the exit in down milling, on both sides of a slot; with angles, where the entry is
/// 0 and the exit 180. Throws `InputError` (Exit::machine_or_force) at the first thing that is wrong.
std::vector<CutSection> read_cutting_model(std::string_view text, const std::string& file);

/// Coefficients from the literature: of a material, as a cutter cut it. Others differ by tens of percent.
struct PublishedCoefficients {
  std::string name;      ///< what `material` says in a file
  std::string material;  ///< for people
  std::string cutter;
  std::string source;
  CuttingCoefficients coefficients;
};

/// All of them, in the order of their data file `src/forces/coefficients.toml`.
const std::vector<PublishedCoefficients>& published_coefficients();

}  // namespace counterflex
