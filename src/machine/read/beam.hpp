#pragma once
/// The tip compliance of a clamped Euler-Bernoulli beam.
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// A prismatic beam along local x: length (m), EA (N), GJ, EIy, EIz (N m2), all positive.
struct Beam {
  double length = 0;
  double EA = 0;
  double GJ = 0;
  double EIy = 0;
  double EIz = 0;
};

/// Displacement and rotation of the beam's end, clamped at its start, per force and moment on the end, in
/// local axes:
///
///     c_xx = L/EA   c_rxrx = L/GJ   c_yy = L³/3EIz   c_rzrz = L/EIz   c_y,rz = +L²/2EIz
///                                   c_zz = L³/3EIy   c_ryry = L/EIy   c_z,ry = −L²/2EIy
Matrix6 tip_compliance(const Beam& beam);

/// The six-by-six `C` of a frame, in axes in which that frame is rotated by `R`.
Matrix6 turned(const Matrix6& C, const Matrix3& R);

}  // namespace counterflex
