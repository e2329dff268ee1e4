#pragma once
/// A program for the tests of forces, and shorthands.
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "counterflex/geometry/units.hpp"
#include "support/programs.hpp"

namespace counterflex::test {

inline Vector6 wrench(double fx, double fy, double fz, double mx = 0, double my = 0, double mz = 0) {
  Vector6 F;
  F << fx, fy, fz, mx, my, mz;
  return F;
}

/// Lines 1 to 6 with N10 to N50 (line 4 has none): rapid, plunge of 10 mm, 10 mm along x, rapid up, and after
/// it 10 mm along y, 10 mm along -x. Feed 10 mm/s.
inline Program sample_program() {
  return ProgramBuilder({0, 0, 20})
      .rapid({0, 0, 10})
      .numbered(10)
      .feed({0, 0, 0}, 600)
      .numbered(20)
      .feed({10, 0, 0}, 600)
      .numbered(30)
      .rapid({10, 0, 5})
      .feed({10, 10, 5}, 600)
      .numbered(40)
      .feed({0, 10, 5}, 600)
      .numbered(50)
      .program;
}

inline PathForces forces_on(const Program& program, const ForceSource& source, const Pose& X_MW = {},
                            const Matrix3& R_MT = Matrix3::Identity()) {
  return PathForces(source, program, build_toolpath(program, X_MW), {R_MT});
}

inline ForceSource from_csv(const std::string& text, double blend = 0) {
  ForceSource source;
  source.profile = read_force_csv(text, "forces.csv");
  source.blend = blend;
  return source;
}

}  // namespace counterflex::test
