#pragma once
/// A program for the tests of forces, and shorthands.
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "counterflex/geometry/types.hpp"
#include "support/programs.hpp"

namespace counterflex::test {

inline Vector6 wrench(double fx, double fy, double fz, double mx = 0, double my = 0, double mz = 0) {
  Vector6 F;
  F << fx, fy, fz, mx, my, mz;
  return F;
}

/// Lines 1 to 6 with N10 to N50 (line 4 has none): rapid, plunge of 10 mm, 10 mm along x, rapid up, and after
/// it 10 mm along y, 10 mm along -x. Feed 10 mm/s. T1 roughs to line 3, T3 finishes.
inline Program sample_program() {
  Program program = ProgramBuilder({0, 0, 20})
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
  program.operations = {"", "Rough pocket", "FINISH WALL"};
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    program.moves[i].tool = i < 3 ? 1 : 3;
    program.moves[i].operation = i < 3 ? 1 : 2;
  }
  return program;
}

inline PathForces forces_on(const Program& program, const ForceSource& source, const Pose& X_MW = {},
                            const Matrix3& R_MT = Matrix3::Identity()) {
  return PathForces(source, program, build_toolpath(program, one_frame(program, {{}, X_MW})), {R_MT});
}

inline ForceSource from_csv(const std::string& text, double blend = 0) {
  ForceSource source;
  source.rules = read_force_csv(text, "forces.csv");
  source.blend = blend;
  return source;
}

inline const std::string on_tool = "# frame = machine\n# sense = on_tool\n";
inline const std::string linear = on_tool + "# interpolation = linear\n";

inline ForceSource constant(const Vector6& F, double blend) {
  ForceSource source;
  source.rules = {{"--force", {}, {}, ConstantForce{F}}};
  source.blend = blend;
  return source;
}

/// One cut of `length_mm` along x at 10 mm/s in blocks of `block_mm`.
inline Program straight(double length_mm, double block_mm) {
  ProgramBuilder builder({0, 0, 0});
  const int blocks = static_cast<int>(length_mm / block_mm + 0.5);
  for (int i = 1; i <= blocks; ++i) builder.feed({i * block_mm, 0, 0}, 600);
  return builder.program;
}

inline bool near(const Vector6& A, const Vector6& B, double tolerance = 1e-9) {
  return (A - B).norm() <= tolerance;
}

}  // namespace counterflex::test
