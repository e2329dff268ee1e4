#pragma once
/// The errors of an actuator's motion, compiled. The kernel reads this: it has only the standard library.
#include <array>
#include <vector>

namespace counterflex {

/// Errors as functions of the actuator's value: a cubic between knots, constant outside; or harmonics.
struct MotionErrors {
  using Six = std::array<double, 6>;  ///< translation (m), rotation vector (rad); axes of the frame before

  std::vector<double> rho{};          ///< knots, increasing (m, rad); empty: no errors
  std::vector<Six> value{}, slope{};  ///< at them; slopes per m or rad

  std::vector<double> harmonics{};  ///< a1, b1, ...: the sum of an sin n rho + bn cos n rho, about the axis

  bool empty() const { return rho.empty() && harmonics.empty(); }
};

}  // namespace counterflex
