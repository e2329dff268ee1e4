#include <fmt/format.h>

#include <cmath>

#include "machine/create/words.hpp"

namespace counterflex::made {
namespace {

constexpr double um_per_m = 1e-6;  // rad
constexpr double tool_length_mm = 100;

/// What is usual for a kind of mill.
struct UsualMill {
  std::string_view name, what;
  double X, Y, Z;           ///< travel (mm)
  double stiffness;         ///< at the tip (N/µm)
  double deviation;         ///< of its compliance (percent)
  std::string_view source;  ///< of the stiffness
};

UsualMill usual(MachineKind kind) {
  switch (kind) {
    case MachineKind::mill3_table:
      return {
          "Mill with a moving table",
          "A vertical mill whose table moves in X and Y. The machine frame M is fixed to the table, and the "
          "tool moves in it: X+ moves the tool in +x of M, the table in the opposite direction.",
          762,
          406,
          508,
          30,
          100,
          "usual for a small vertical mill: 10 to 60 N/µm"};
    case MachineKind::gantry:
      return {"Gantry", "A portal mill or router: the gantry moves in X over the table, the head in Y and Z.",
              3000,     1500,
              600,      20,
              100,      "usual for a portal mill: 5 to 50 N/µm; a router has 1 to 10"};
    case MachineKind::table_ac:
    case MachineKind::table_bc:
      return {
          kind == MachineKind::table_ac ? "Mill with a table A C" : "Mill with a table B C",
          "A mill whose table turns. The machine frame M turns with the table. The rotary axes stay at their "
          "home_deg while a program runs: enter their values for 3+2 work, in a copy of this file for each "
          "position, and leave the rotary words out of the program. Five-axis programs are not corrected.",
          500,
          500,
          400,
          30,
          100,
          "usual for a small five-axis mill: 10 to 60 N/µm"};
    default:
      return {"Mill",
              "A vertical mill whose tool moves in X, Y and Z. The machine frame M is fixed to the table.",
              600,
              400,
              400,
              30,
              100,
              "usual for a small vertical mill: 10 to 60 N/µm"};
  }
}

/// Rotations (rad) of the slots XY (about z), YZ (about x) and ZX (about y), in this order between X, Y and
/// Z, for angles between the axes of 90 degrees and `excess` (rad: XY, YZ, ZX). Exact.
///
///     z' . y = -sin YZ      z' . x = -sin ZX      x = (cos XY, -sin XY, 0) behind the slot XY
Vector3 slot_angles(const Vector3& excess) {
  const double z_y = -std::sin(excess.y());
  const double z_x = (-std::sin(excess.z()) + z_y * std::sin(excess.x())) / std::cos(excess.x());
  const double about_y = std::asin(z_x);
  return {excess.x(), std::asin(-z_y / std::cos(about_y)), about_y};
}

std::string axis_line(char letter, const AxisRange& range) {
  const char axis = static_cast<char>(letter - 'X' + 'x');
  return fmt::format(
      "  {{ actuator = \"prismatic\", axis = \"{}\", min_mm = {}, max_mm = {}, home_mm = {} }},\n", axis,
      number(range.min), number(range.max), number((range.min + range.max) / 2));
}

std::string compliance_line(int axis, double k) {
  return fmt::format(
      "  {{ compliance = \"prismatic\", axis = \"{}\", stiffness_N_per_m = {}, name = \"{}\" }},  # {:.4g} "
      "N/µm\n",
      "xyz"[axis], number(k), "XYZ"[axis], k / N_per_um);
}

/// The swivel of a rotary table: A about x or B about y.
struct Swivel {
  char letter;
  std::string_view axis;
  std::vector<std::string_view> errors;  ///< of its place
};

std::string rotary_line(std::string_view axis, std::string_view external, const AxisRange& range) {
  return fmt::format(
      "  {{ actuator = \"revolute\", axis = \"{}\", program_axis = \"{}\", min_deg = {}, max_deg = {}, "
      "home_deg "
      "= 0 }},\n",
      axis, external, number(range.min), number(range.max));
}

class Mill {
 public:
  explicit Mill(const MachineFacts& facts)
      : facts_(facts),
        usual_(usual(facts.kind)),
        X_(travel_of(facts, 'X', {0, usual_.X})),
        Y_(travel_of(facts, 'Y', {0, usual_.Y})),
        Z_(travel_of(facts, 'Z', {-usual_.Z, 0})) {
    if (facts.kind == MachineKind::table_ac) swivel_ = {'A', "x", {"y_mm", "z_mm", "ry_deg", "rz_deg"}};
    if (facts.kind == MachineKind::table_bc) swivel_ = {'B', "y", {"x_mm", "z_mm", "rx_deg", "rz_deg"}};
  }

  std::string text() const { return head() + chain() + parameters(); }

 private:
  Vector3 stiffness() const {
    return facts_.tip_stiffness.value_or(Vector3::Constant(usual_.stiffness * N_per_um));
  }

  Vector3 middle() const { return {(X_.min + X_.max) / 2, (Y_.min + Y_.max) / 2, Z_.min - tool_length_mm}; }
  Vector3 pivot() const { return facts_.pivot_mm.value_or(middle()); }

  std::string head() const {
    const Vector3 work = middle() + Vector3(0, 0, (Z_.max - Z_.min) / 4);
    std::string_view kind;
    for (const KindOfMachine& known : kinds_of_machine)
      if (known.kind == facts_.kind) kind = known.name;
    return title({fmt::format("counterflex new {}", kind), std::string(usual_.what),
                  facts_.name.empty() ? std::string(usual_.name) : facts_.name, R"("x", "y", "z")"}) +
           fmt::format(
               "\n[spindle]  # tool lengths count from the spindle nose\n"
               "\n[tool]     # tip of a tool that is not in [tools]: replace it, or add [tools.T1] with "
               "length_mm\n"
               "xyz_mm = [0, 0, {}]\n",
               number(-tool_length_mm)) +
           work_offset("G54", work) + "\n[limits]\nmax_correction_mm = 0.5\n";
  }

  std::string chain() const {
    const Vector3 k = stiffness();
    std::string text = "\n[[chain]]\nname = \"axes\"\nelements = [\n";
    if (swivel_.letter != 0) text += table();
    text += "  # the deflection of the whole machine at the tool tip\n";
    for (int axis = 0; axis < 3; ++axis) text += compliance_line(axis, k[axis]);
    text += axis_line('X', X_) + "  { error = \"XY\" },       # squareness of X and Y\n" +
            axis_line('Y', Y_) +
            "  { error = \"YZ\" },       # squareness of Y and Z\n"
            "  { error = \"ZX\" },       # squareness of Z and X\n" +
            axis_line('Z', Z_) + "  { error = \"spindle\" },  # tilt of the spindle\n]\n";
    const auto& [XY, YZ, ZX] = facts_.squareness_um_per_m;
    if (!XY && !YZ && !ZX) return text;
    const Vector3 excess = Vector3(XY.value_or(0), YZ.value_or(0), ZX.value_or(0)) * um_per_m;
    const Vector3 angle = slot_angles(excess) / deg;
    const auto line = [](std::string_view slot, const Vector3& rotation, const std::optional<double>& given) {
      return fmt::format("errors.{} = {{ rotvec_deg = {} }}  # {}\n", slot, triple(rotation),
                         given ? number(*given) + " µm/m" : "not given");
    };
    return text + "# Positive: the angle between the positive directions of the axes is above 90 degrees.\n" +
           line("XY", {0, 0, angle.x()}, XY) + line("YZ", {angle.y(), 0, 0}, YZ) +
           line("ZX", {0, angle.z(), 0}, ZX);
  }

  std::string table() const {
    return fmt::format(
               "  {{ rigid = {{ xyz_mm = {} }} }},  # where the rotary axes cross\n"
               "  # Positive: the tool turns against the table, as in ISO 841. Else reverse the axis: [0, 0, "
               "-1].\n",
               triple(pivot())) +
           rotary_line("z", "E2", travel_of(facts_, 'C', {-360, 360})) +
           "  { error = \"C\" },        # place and direction of C\n" +
           rotary_line(swivel_.axis, "E1", travel_of(facts_, swivel_.letter, {-120, 120})) +
           fmt::format("  {{ error = \"{}\" }},        # place and direction of {}\n", swivel_.letter,
                       swivel_.letter) +
           fmt::format("  {{ rigid = {{ xyz_mm = {} }} }},\n", triple(-pivot()));
  }

  static Knowledge of_squareness(const std::optional<double>& given) {
    if (given)
      return {sigma(3 * um_per_m / deg), NumberSource::measured,
              "--squareness-um-per-m; 3 µm/m as of a ball bar"};
    return {sigma(50 * um_per_m / deg), NumberSource::prior, "50 µm/m, usual after some years of use"};
  }

  std::string parameters() const {
    const auto& [XY, YZ, ZX] = facts_.squareness_um_per_m;
    const Knowledge tilt{sigma(50 * um_per_m / deg), NumberSource::prior, "50 µm/m, usual; tram the spindle"};
    const Knowledge stiffness =
        facts_.tip_stiffness
            ? Knowledge{percent(5), NumberSource::measured,
                        "--tip-stiffness-N-per-um; 5 % as of gauge and load cell"}
            : Knowledge{percent(usual_.deviation), NumberSource::prior, std::string(usual_.source)};
    std::string text = parameters_header() + stated("XY.rz_deg", of_squareness(XY)) +
                       stated("YZ.rx_deg", of_squareness(YZ)) + stated("ZX.ry_deg", of_squareness(ZX)) +
                       stated("spindle.rx_deg", tilt) + stated("spindle.ry_deg", tilt);
    if (swivel_.letter != 0) {
      const Knowledge place{sigma(0.02), NumberSource::prior, "usual before the axes are calibrated"};
      const Knowledge direction{sigma(50 * um_per_m / deg), NumberSource::prior, "50 µm/m, usual"};
      text += stated_errors("C", {"x_mm", "y_mm", "rx_deg", "ry_deg"}, place, direction) +
              stated_errors(std::string(1, swivel_.letter), swivel_.errors, place, direction);
    }
    for (const char axis : {'X', 'Y', 'Z'})
      text += stated(fmt::format("{}.compliance_m_per_N", axis), stiffness);
    return text;
  }

  const MachineFacts& facts_;
  UsualMill usual_;
  AxisRange X_, Y_, Z_;
  Swivel swivel_{0, "", {}};
};

}  // namespace

std::string mill_file(const MachineFacts& facts) {
  return Mill(facts).text();
}

}  // namespace counterflex::made
