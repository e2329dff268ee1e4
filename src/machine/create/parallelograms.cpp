#include <fmt/format.h>

#include <array>
#include <cmath>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/pose.hpp"
#include "machine/create/words.hpp"

namespace counterflex::made {
namespace {

constexpr double half_width_mm = 40;  // of a parallelogram

/// A bar between free joints at `half_width_mm` beside the middle; x along the bars, z across.
std::string bar_branch(std::string_view name, double z_mm, double arm_mm) {
  return fmt::format(
      "\n[branches.{}]\nelements = [\n"
      "  {{ rigid = {{ xyz_mm = [0, 0, {}] }} }},\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ rigid = {{ xyz_mm = [{}, 0, 0] }} }},\n"
      "  {{ spring = \"bar\" }},\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ rigid = {{ xyz_mm = [0, 0, {}] }} }},\n"
      "]\n",
      name, number(z_mm), number(arm_mm), number(-z_mm));
}

std::string bars(double arm_mm, std::string_view beam) {
  return fmt::format("\n[springs.bar]\nbeam = {{ length_mm = {}, {} }}\n", number(arm_mm), beam) +
         bar_branch("left_bar", half_width_mm, arm_mm) + bar_branch("right_bar", -half_width_mm, arm_mm);
}

std::string parallelogram_head(const MachineFacts& facts, std::string_view kind, std::string_view what,
                               std::string_view name, double tool_mm) {
  std::string text = title({fmt::format("counterflex new {}", kind), std::string(what),
                            facts.name.empty() ? std::string(name) : facts.name, R"("x", "y", "z")"}) +
                     "\n[home]  # the platform in M, with the carriages in the middle of their travel\n"
                     "xyz_mm = [0, 0, 0]\n";
  if (tool_mm != 0)
    text +=
        fmt::format("\n[tool]  # from the platform to the tip: replace it by yours\nxyz_mm = [0, 0, {}]\n",
                    number(-tool_mm));
  return text + work_offset("G54", {0, 0, -tool_mm}) + "\n[limits]\nmax_correction_mm = 2\n";
}

Knowledge drive_knowledge(const MachineFacts& facts, std::string_view usual) {
  return facts.leg_stiffness ? Knowledge{percent(10), NumberSource::catalogue, "--leg-stiffness-N-per-um"}
                             : Knowledge{percent(100), NumberSource::prior, std::string(usual)};
}

double positive_arm(const MachineFacts& facts, double usual_mm) {
  const double arm_mm = facts.arm_mm.value_or(usual_mm);
  if (arm_mm > 0) return arm_mm;
  throw InputError(ErrorKind::usage, {}, fmt::format("--arm-mm is {}, must be above 0", number(arm_mm)));
}

}  // namespace

std::string delta_file(const MachineFacts& facts) {
  const double arm_mm = positive_arm(facts, 500), radius_mm = facts.radius_mm.value_or(0.48 * arm_mm);
  if (!(radius_mm > 0 && radius_mm < arm_mm))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--radius-mm is {}, must be above 0 and below the arm, {} mm",
                                 number(radius_mm), number(arm_mm)));
  const double height_mm = std::sqrt(arm_mm * arm_mm - radius_mm * radius_mm);
  const double platform_mm = 0.12 * arm_mm;  // its joints; only the difference to the rails moves the tip
  Matrix3 R;                                 // x along the bars, z across the parallelogram
  R.col(0) = Vector3(-radius_mm, 0, -height_mm) / arm_mm;
  R.col(2) = Vector3::UnitY();
  R.col(1) = R.col(2).cross(R.col(0));
  const AxisRange travel = travel_of(facts, 'L', {-0.4 * arm_mm, 0.4 * arm_mm});
  std::string text =
      parallelogram_head(facts, "delta",
                         "A delta machine: three carriages on vertical rails hold the platform by "
                         "parallelograms. x of a leg points "
                         "outwards. --arm-mm is the length of the bars between their joints, --radius-mm "
                         "their horizontal length "
                         "with the platform in the centre.",
                         "Delta", 60) +
      "\n# bars: carbon tubes, 12 mm outside and 10 mm inside, E = 100 GPa, G = 5 GPa" +
      bars(arm_mm, "EA_N = 3.46e6, GJ_Nm2 = 5.3, EIy_Nm2 = 52.7, EIz_Nm2 = 52.7");
  text += fmt::format(
      "\n[templates.leg]\n"
      "elements = [\n"
      "  {{ rigid = {{ xyz_mm = [{}, 0, {}] }} }},\n"
      "  {{ error = \"rail\" }},  # place of the rail, end stop (z), lean\n"
      "  {{ actuator = \"prismatic\", axis = \"z\", min_mm = {}, max_mm = {} }},  # from home\n"
      "  {{ compliance = \"prismatic\", axis = \"z\", stiffness_N_per_m = {}, name = \"drive\" }},\n"
      "  {{ rigid = {{ {} }} }},  # x along the bars, z across the parallelogram\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ parallel = [\"left_bar\", \"right_bar\"] }},\n"
      "  {{ error = \"arm\" }},  # length of the bars (x)\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ rigid = {{ {} }} }},\n"
      "  {{ rigid = {{ xyz_mm = [{}, 0, 0] }} }},\n"
      "]\n",
      number(radius_mm + platform_mm), number(height_mm), number(travel.min), number(travel.max),
      number(facts.leg_stiffness.value_or(2.5 * N_per_um)), turned(R), turned(R.transpose()),
      number(-platform_mm));
  for (int i = 0; i < 3; ++i)
    text += fmt::format(
        "\n[[chain]]\nname = \"rail{}\"\nbase = {{ rpy_deg = [0, 0, {}] }}\nuse = \"leg\"\n"
        "platform = {{ rpy_deg = [0, 0, {}] }}\n",
        i + 1, 90 + 120 * i, -90 - 120 * i);
  const Knowledge place{sigma(0.2), NumberSource::prior, "usual before calibration"};
  const Knowledge lean{sigma(0.05), NumberSource::prior, "usual before calibration"};
  const Knowledge bar{percent(50), NumberSource::prior, "tubes of carbon fibre"};
  text += parameters_header();
  for (int i = 1; i <= 3; ++i) {
    const std::string name = fmt::format("rail{}", i);
    text +=
        stated(name + ".drive.compliance_m_per_N",
               drive_knowledge(facts, "2.5 N/µm, usual for a belt: 0.5 to 5; a ball screw has 20 to 100"));
    for (const std::string_view side : {"left_bar", "right_bar"})
      text += stated(fmt::format("{}.{}.bar.compliance_m_per_N", name, side), bar);
    text += stated_errors(name + ".rail", {"x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg"}, place, lean) +
            stated_errors(name + ".arm", {"x_mm"}, place, lean);
  }
  return text;
}

std::string orthoglide_file(const MachineFacts& facts) {
  const double arm_mm = positive_arm(facts, 310.25), foot_mm = 110.4, platform_mm = 45.2;
  const AxisRange travel = travel_of(facts, 'L', {-0.4 * arm_mm, 0.8 * arm_mm});
  std::string text =
      parallelogram_head(facts, "orthoglide",
                         "An Orthoglide: three rails along x, y and z move the platform by parallelograms. "
                         "x of a leg is along its "
                         "rail. --arm-mm is the length of the bars between their joints. The other lengths "
                         "and the bars are those "
                         "of the Orthoglide of IRCCyN.",
                         "Orthoglide", 0) +
      bars(arm_mm, "EA_N = 10.08e6, GJ_Nm2 = 13.034, EIy_Nm2 = 100.0, EIz_Nm2 = 33.409");
  text += fmt::format(
      "\n[templates.leg]\n"
      "elements = [\n"
      "  {{ rigid = {{ xyz_mm = [{}, {}, 0] }} }},\n"
      "  {{ error = \"mount\" }},  # of the rail\n"
      "  {{ actuator = \"prismatic\", axis = \"x\", min_mm = {}, max_mm = {} }},  # from home\n"
      "  {{ compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = {}, name = \"drive\" }},\n"
      "  {{ rigid = {{ xyz_mm = [0, {}, 0] }} }},  # the foot\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ parallel = [\"left_bar\", \"right_bar\"] }},\n"
      "  {{ error = \"arm\" }},    # length of the bars (x)\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ rigid = {{ xyz_mm = [{}, 0, 0] }} }},\n"
      "]\n",
      number(-arm_mm - platform_mm), number(-foot_mm), number(travel.min), number(travel.max),
      number(facts.leg_stiffness.value_or(3 * N_per_um)), number(foot_mm), number(platform_mm));
  constexpr std::array<std::string_view, 3> names = {"x", "y", "z"};
  constexpr std::array<std::string_view, 3> ends = {
      "", "base = { quat_wxyz = [0.5, 0.5, 0.5, 0.5] }\nplatform = { quat_wxyz = [0.5, -0.5, -0.5, -0.5] }\n",
      "base = { quat_wxyz = [0.5, -0.5, -0.5, -0.5] }\nplatform = { quat_wxyz = [0.5, 0.5, 0.5, 0.5] }\n"};
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("\n[[chain]]\nname = \"{}\"\nuse = \"leg\"\n{}", names[i], ends[i]);
  const Knowledge place{sigma(0.1), NumberSource::prior, "usual before calibration"};
  const Knowledge direction{sigma(0.05), NumberSource::prior, "usual before calibration"};
  const Knowledge bar{percent(50), NumberSource::prior,
                      "aluminium bars of 144 mm2; bending identified in arXiv:1211.5795"};
  text += parameters_header();
  for (const std::string_view name : names) {
    text += stated(fmt::format("{}.drive.compliance_m_per_N", name),
                   drive_knowledge(facts, "3 N/µm, as the feet of the Orthoglide along their rails"));
    for (const std::string_view side : {"left_bar", "right_bar"})
      text += stated(fmt::format("{}.{}.bar.compliance_m_per_N", name, side), bar);
    text += stated_errors(fmt::format("{}.mount", name),
                          {"x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg"}, place, direction) +
            stated_errors(fmt::format("{}.arm", name), {"x_mm"}, place, direction);
  }
  return text;
}

}  // namespace counterflex::made
