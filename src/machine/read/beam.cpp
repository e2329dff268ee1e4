#include "machine/read/beam.hpp"

namespace counterflex {

Matrix6 tip_compliance(const Beam& beam) {
  enum { x, y, z, rx, ry, rz };
  const double L = beam.length;
  Matrix6 C = Matrix6::Zero();
  C(x, x) = L / beam.EA;
  C(rx, rx) = L / beam.GJ;
  C(y, y) = L * L * L / (3 * beam.EIz);
  C(rz, rz) = L / beam.EIz;
  C(y, rz) = C(rz, y) = L * L / (2 * beam.EIz);
  C(z, z) = L * L * L / (3 * beam.EIy);
  C(ry, ry) = L / beam.EIy;
  C(z, ry) = C(ry, z) = -L * L / (2 * beam.EIy);
  return C;
}

Matrix6 turned(const Matrix6& C, const Matrix3& R) {
  Matrix6 Q = Matrix6::Zero();
  Q.topLeftCorner<3, 3>() = R;
  Q.bottomRightCorner<3, 3>() = R;
  return Q * C * Q.transpose();
}

}  // namespace counterflex
