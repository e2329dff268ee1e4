#pragma once
/// Mechanistic cutting forces of an end mill: the mean wrench over a revolution, or that which acts while a
/// tooth makes the wall.
#include <string>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// What a tooth's edge feels, by length of edge and chip thickness h:
///
///     dF_t = (K_tc h + K_te) dz      dF_r = (K_rc h + K_re) dz      dF_a = (K_ac h + K_ae) dz
///
/// t against the cutting speed, r towards the tool's axis, a along it, away from the spindle. Source:
/// Altintas, "Manufacturing Automation", chapter 2.
struct CuttingCoefficients {
  double K_tc = 0, K_rc = 0, K_ac = 0;  ///< N/m2
  double K_te = 0, K_re = 0, K_ae = 0;  ///< N/m
};

/// Right-hand cutter that turns clockwise, seen from the spindle. Angles of immersion count from the feed
/// frame's y axis towards its x axis: a tooth at angle phi stands at (sin phi, cos phi) of the radius.
struct EndMill {
  double diameter = 0;  ///< m
  int flutes = 0;
  double helix = 0;  ///< rad
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
  Wall wall = Wall::none;
  ForceAt force_at = ForceAt::mean;
  double spindle_rpm = 0;  ///< instead of the program's; 0: the program's
};

/// The wrench on the tool at its tip, axes of the feed frame (N, N m), or why there is none.
struct CutForce {
  Vector6 F = Vector6::Zero();
  std::string why;  ///< empty: `F` acts
};

/// The force of a cut at programmed feed (m/s, 0: none) and spindle speed (1/min, 0: none). `slope` is the
/// component of the feed's unit vector along the tool axis, from tip to spindle: -1 straight down. What is
/// left sideways of the feed makes the chips; a plunge or a retract makes none that the model knows.
CutForce cutting_force(const CuttingModel& model, double feed_m_s, double spindle_rpm, double slope);

}  // namespace counterflex
