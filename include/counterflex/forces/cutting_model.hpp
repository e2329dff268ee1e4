#pragma once
/// Mechanistic cutting forces of an end mill: the mean wrench over a revolution, or the wrench that acts
/// while a tooth makes the wall.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// What a tooth's edge feels over a chip width db, at chip thickness h = c sin phi sin kappa (c: feed per
/// tooth; kappa: angle between the tool's axis and the normal of the cutter's surface, 90 deg on a cylinder):
///
///     dF_t = (K_tc h^p + K_te) db      dF_r = (K_rc h^p + K_re) db      dF_a = (K_ac h^p + K_ae) db
///
/// with p = 1 - m_c. With m_c > 0 this is Kienzle's law: K_tc = kc1.1 (1 mm)^m_c, so that the force on the
/// chip's section h db is kc1.1 (h / 1 mm)^-m_c. Source: Kienzle, "Die Bestimmung von Kraeften und Leistungen
/// an spanenden Werkzeugen und Werkzeugmaschinen", VDI-Z 94 (1952).
///
/// t against the cutting speed, r against the normal n of the cutter's surface, a against its upward tangent
/// m: on a cylinder towards the tool's axis, and along it away from the spindle. On the tool, in the feed
/// frame (x along the feed, z from tip to spindle):
///
///     dF = -dF_t (cos phi, -sin phi, 0) - dF_r n - dF_a m
///     n = (sin kappa sin phi, sin kappa cos phi, -cos kappa)
///     m = (cos kappa sin phi, cos kappa cos phi, sin kappa)
///     dM = r x dF      r = (R sin phi, R cos phi, z)      z: height above the tip, R: radius there
///
/// A positive K_ac draws the tool out of the spindle: the rake face of a right-hand helix looks forward and
/// up, so it lifts the chip, and the chip presses on it backward and down. Source: Altintas, "Manufacturing
/// Automation", chapter 2; the sign of the axial part is that of Engin and Altintas, "Mechanics and dynamics
/// of general milling cutters, part I" (2001), whose third row is dF_z = cos(kappa) dF_r - sin(kappa) dF_a,
/// kappa = 90 deg for an end mill. The book's formula for a cylindrical cutter, dF_z = +dF_a, has the other
/// sign.
struct CuttingCoefficients {
  double K_tc = 0, K_rc = 0, K_ac = 0;  ///< N/m^(2 - m_c)
  double K_te = 0, K_re = 0, K_ae = 0;  ///< N/m
  double m_c = 0;                       ///< 0 to less than 1
};

/// kc1.1: the tangential force on a chip that is 1 mm thick, over its section (N/m2).
double main_value(const CuttingCoefficients& coefficients);

/// Thrust over cutting force of a twist drill: Tc D / (4 Mc) of the formulas Tc = 570 K D f^0.85 and
/// Mc = K D^2 (0.630 + 16.84 f) / 100 (N, N m, mm) is 0.87 to 0.91 for feeds f of 0.1 to 0.4 mm, for any K
/// and D. Source of the formulas: Tungaloy, General Catalogue 2020-2021, User's Guide, page L068.
inline constexpr double usual_thrust_share = 0.9;

/// Right-hand cutter that turns clockwise, seen from the spindle. Angles of immersion count from the feed
/// frame's y axis towards its x axis: a tooth at angle phi is at (sin phi, cos phi) of the radius.
struct EndMill {
  double diameter = 0;  ///< m
  int flutes = 0;
  double helix = 0;          ///< rad
  double corner_radius = 0;  ///< m; 0: a flat end; half of the diameter: a ball
  double point_angle = 0;    ///< of its tip, rad, where it plunges as a drill; 0: it does not
  double thrust_share = usual_thrust_share;
};

enum class ForceAt { mean, surface };

/// Where a surface is made: by a tooth that enters (up milling), or leaves (down); in a slot by both.
enum class Wall { none, entry, exit, both };

/// The cut of a section of a program.
struct CuttingModel {
  EndMill mill;
  CuttingCoefficients coefficients;
  double axial_depth = 0;      ///< m
  double entry = 0, exit = 0;  ///< angles of immersion, rad
  /// Of a cutter with a corner radius: distance to the pass before (m). Where the cutter is narrower the
  /// angle of immersion is that of this depth there. 0: `entry` and `exit` are those of every height.
  double radial_depth = 0;
  Wall wall = Wall::none;
  ForceAt force_at = ForceAt::mean;
  double spindle_rpm = 0;  ///< instead of the program's; 0: the program's
};

/// What a cut answers to a feed per tooth c: F = F_c c^p + F_e. Made once for a model, asked for every move.
struct CutResponse {
  Vector6 F_c = Vector6::Zero();  ///< of the chip (N/m^p, N m/m^p), axes of the feed frame, at the tip
  Vector6 F_e = Vector6::Zero();  ///< of the edge (N, N m)
  int flutes = 0;
  double spindle_rpm = 0;  ///< instead of the program's; 0: the program's
  double diameter = 0;     ///< of the cutter (m)
  double p = 1;            ///< 1 - m_c
  bool mills = true, drills = false;
  Vector6 T_c = Vector6::Zero(), T_e = Vector6::Zero();  ///< of a plunge, as F_c and F_e
};

/// The wrench on the tool at its tip, axes of the feed frame (N, N m), or why no force acts.
struct CutForce {
  Vector6 F = Vector6::Zero();
  double feed_per_tooth = 0;  ///< m; c
  double chip_torque = 0;     ///< N m; the part of the torque that is proportional to K_tc
  std::string why;            ///< empty: `F` acts
};

/// Steeper than this a feed is along the tool axis: a plunge or a retract. Slope is the component of the
/// feed's unit vector along the tool axis, from tip to spindle: -1 straight down.
inline constexpr double steepest_ramp = 0.984807753012208;  // sin 80 deg

/// The response of a cut.
///
/// `ForceAt::mean`: the mean over a revolution of N flutes,
///
///     N / (2 pi) int_0^a int_entry^exit dF
///
/// in which the helix shows no more: every height sees the same angles, only later. `ForceAt::surface`: the
/// force while a tooth makes the wall at angle phi_w, 0 for a wall at the entry and pi for one at the exit;
/// in a slot the mean of both. The upper end of a flute lags by psi(z) = 2 z tan(helix) / D, so that every
/// height z_w of the wall has its own instant; the force is the mean over z_w of
///
///     sum_i int_0^a dF at phi = phi_w + psi(z_w) - psi(z) + 2 pi i / N, where entry <= phi <= exit
///
/// Both ends count: a straight flute that makes the wall cuts with its whole edge. With a helix that tooth is
/// still entering, or already leaving, and on average half of its edge is in the cut, however small the helix
/// is: the edge part of a tooth at the wall halves, what the chip gives does not jump, for there h = 0.
///
/// A plunge of a cutter that drills has the force of N edges of width b = D / (2 sin kappa), kappa half of
/// the point angle, at chip thickness h = c sin kappa:
///
///     F_z = share F_v      M_z = F_v D / 4      F_v = N (K_tc h^p + K_te) b
///
/// F_v acts in the middle of the edges, and a part of it, `thrust_share`, pushes the tool up. Source of h, b
/// and the arm: Tabellenbuch Metall (Europa-Lehrmittel), cutting force and power in drilling; of the share
/// see `usual_thrust_share`.
///
/// Requires the model to be what `read_cutting_model` accepts: 0 <= entry < exit <= pi, a wall for `surface`
/// and no corner radius with it; or a cutter that drills and no axial depth.
CutResponse respond(const CuttingModel& model);

/// The force of a cut at a feed (m/s) and a spindle speed (1/min) of the program, 0: unknown. What is left
/// sideways of the feed makes the chips, c = feed sqrt(1 - slope^2) / (n N); a ramp is cut with that. Where
/// the feed is along the tool axis (beyond `steepest_ramp`) only the plunge of a cutter that drills has a
/// force, with c = feed / (n N). No force acts where no feed is programmed, where neither model nor program
/// give a spindle speed, and where a cutter that only drills moves sideways.
CutForce cutting_force(const CutResponse& response, double feed_m_s, double spindle_rpm, double slope);

/// The same for a model that is used once.
CutForce cutting_force(const CuttingModel& model, double feed_m_s, double spindle_rpm, double slope);

// Which forces act where: rules, of which the most specific one that covers a move acts.

enum class ForceFrame { machine, work, tool, feed };

/// How specific a rule is; the first is the most specific. A place is a line, a block number, a length, a
/// time, a point, or a FORCE comment.
enum class ForceRank { place, operation, tool, program };

/// Which moves a rule covers: those that meet all conditions that are given.
struct ForceSelector {
  std::optional<long> tool;              ///< T in the spindle
  std::optional<std::string> operation;  ///< the operation's comment, case aside; `*` at its end: begins so
  std::optional<std::array<long, 2>> lines;   ///< first and last
  std::optional<std::array<long, 2>> blocks;  ///< first and last N
};

/// By the most specific of the conditions that are given.
ForceRank rank(const ForceSelector& selector);

/// The same wrench for all moves of a rule.
struct ConstantForce {
  Vector6 F = Vector6::Zero();  ///< on the tool (N, N m)
  ForceFrame frame = ForceFrame::machine;
  bool at_platform = false;  ///< acts at the reference point instead of the tip
};

// Reading cutting models, and the coefficients that the tool brings along.

/// The data in a file about a part of the program: which part, and how it is cut.
struct CutSection {
  std::string name;  ///< `section 1`, counted from 1, unless the file gives one
  Location where;
  std::string cutter, material;  ///< names in the file
  ForceSelector selector;
  CuttingModel model;
};

/// Reads a TOML file of cutting models (format = "counterflex-forces 1"):
///
///     force_at = "mean" | "surface"      for all sections without `force_at`; default "mean"
///     [cutters.NAME]                     diameter_mm, flutes, helix_deg (0 to 60); corner_radius_mm, 0 by
///                                        default; point_angle_deg (60 to 180) and thrust_share, of a cutter
///                                        that drills. Without helix_deg it only drills.
///     [materials.NAME]                   Ktc_N_mm2 and Krc_N_mm2; Kac_N_mm2, Kte_N_mm, Kre_N_mm, Kae_N_mm, 0
///                                        by default; or kc11_N_mm2 and mc, with radial_share and axial_share
///                                        of the tangential force; override names of `published_coefficients`
///     [[section]]                        in any number:
///       name                             for messages
///       tool = "T3", op = "POCKET*", lines = [10, 200], blocks = [10, 90]
///                                        which moves: those that meet all that is given
///       cutter, material                 names
///       radial_share, axial_share        of a material with kc11_N_mm2, unless its table gives them
///       axial_depth_mm                   this and the engagement not for a cutter that only drills
///       radial_depth_mm, side = "up" | "down"; or side = "slot"; or entry_deg and exit_deg (0 to 180)
///       spindle_rpm                      instead of the program's S
///       force_at
///
/// A radial depth a_e enters at 0 and leaves at acos(1 - 2 a_e / D) in up milling, enters at pi less that and
/// leaves at pi in down milling; a slot is cut from 0 to pi. The wall that `surface` refers to is at the
/// entry in up milling, at the exit in down milling, on both sides of a slot; with angles, where the entry is
/// 0 and the exit 180. Throws `InputError` (ErrorKind::machine_or_force) at the first thing that is wrong.
std::vector<CutSection> read_cutting_model(std::string_view text, const std::string& file);

/// Coefficients from the literature: of a material, as a cutter cut it. Others differ by tens of percent.
struct PublishedCoefficients {
  std::string name;      ///< the value of `material` in a file
  std::string material;  ///< for people
  std::string cutter;
  std::string source;
  CuttingCoefficients coefficients;  ///< with m_c > 0: K_tc alone, the shares are the user's
};

/// All of them, in the order of their data file `src/forces/coefficients.toml`.
const std::vector<PublishedCoefficients>& published_coefficients();

}  // namespace counterflex
