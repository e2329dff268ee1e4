#pragma once
/// Rigid gantries whose deviation is known in closed form.
#include <fmt/format.h>

#include "compensation/support/judge.hpp"

namespace counterflex::test {

/// Three prismatic actuators X, Y, Z; the frame displaced (mm) and turned about Z, Y turned against X about
/// Z, and Z against both about Y (rad).
inline Machine rigid_gantry(const std::string& displaced_mm, double square_error = 0, double lean = 0,
                            double turn = 0) {
  return read_machine(fmt::format(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[[chain]]
name = "axes"
elements = [
  {{ error = "mount" }},
  {{ actuator = "prismatic", axis = "x", min_mm = -1000, max_mm = 1000 }},
  {{ error = "y_to_x" }},
  {{ actuator = "prismatic", axis = "y", min_mm = -1000, max_mm = 1000 }},
  {{ error = "z_to_y" }},
  {{ actuator = "prismatic", axis = "z", min_mm = -1000, max_mm = 1000 }},
]
errors.mount = {{ xyz_mm = [{}], rpy_deg = [0, 0, {}] }}
errors.y_to_x = {{ rpy_deg = [0, 0, {}] }}
errors.z_to_y = {{ rpy_deg = [0, {}, 0] }}
)",
                                  displaced_mm, turn / deg, square_error / deg, lean / deg),
                      "gantry.toml");
}

inline Machine displaced_gantry() {
  return rigid_gantry("0.5, -0.25, 0.125");
}
inline Machine perfect_gantry() {
  return rigid_gantry("0, 0, 0");
}

/// A head that deflects evenly, 10 µm under 100 N.
inline Machine yielding_gantry() {
  Machine machine = perfect_gantry();
  Spring spring;
  spring.K.diagonal() << 1e7, 1e7, 1e7, 1e6, 1e6, 1e6;
  machine.chains[0].elements.push_back(spring);
  return machine;
}

/// Slides X, Y, Z; `x` are keys of X, `head` is an element behind Z, `definitions` are tables of the file.
inline Machine slides(const std::string& definitions, const std::string& x, const std::string& head) {
  return read_machine("format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n" +
                          definitions + R"([[chain]]
name = "axes"
elements = [
  { actuator = "prismatic", axis = "x", min_mm = -1000, max_mm = 1000)" +
                          x + R"( },
  { actuator = "prismatic", axis = "y", min_mm = -1000, max_mm = 1000 },
  { actuator = "prismatic", axis = "z", min_mm = -1000, max_mm = 1000 },
)" + head + "]\n",
                      "slides.toml");
}

/// A joint behind a head whose stiffness (N/m) is another one above a load.
inline std::string knee_along(char axis, double below, double knee_N, double above) {
  return fmt::format(
      "  {{ compliance = \"prismatic\", axis = \"{}\", stiffness_N_per_m = {}, knee_N = {}, "
      "stiffness_above_N_per_m = {} }},\n",
      axis, below, knee_N, above);
}

/// What the displaced gantry's programs are shifted by (mm).
inline const Vector3 shift_mm(-0.5, 0.25, -0.125);

inline std::vector<Move> moves_in(const std::string& text) {
  return read_program(text, "part.ngc", {}).moves;
}

inline std::vector<Move> arcs_in(const std::string& text) {
  std::vector<Move> arcs;
  for (const Move& move : moves_in(text))
    if (move.arc) arcs.push_back(move);
  return arcs;
}

/// GRBL's rule for the radii of an arc's ends, without the share of the radius that it allows; LinuxCNC's is
/// wider.
inline void check_radii(const std::string& text) {
  for (const Move& move : arcs_in(text)) {
    CAPTURE(move.line);
    const Vector3 normal = Vector3::Unit(move.arc->normal);
    const auto radius = [&](const Vector3& p) { return normal.cross(p - move.arc->centre_mm).norm(); };
    CHECK(std::abs(radius(move.start_mm) - radius(move.end_mm)) <= 0.005);
  }
}

}  // namespace counterflex::test
