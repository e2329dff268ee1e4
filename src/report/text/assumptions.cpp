#include "report/text/assumptions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex {

namespace {

std::string three(const Vector3& v, int decimals) {
  return fmt::format("({}, {}, {})", format_fixed(v.x(), decimals), format_fixed(v.y(), decimals),
                     format_fixed(v.z(), decimals));
}

std::string place(const Pose& X) {
  std::string text = three(X.p / mm, 4) + " mm in the machine frame";
  const Vector3 rpy = to_rpy(X.R) / deg;
  if (rpy.cwiseAbs().maxCoeff() > 5e-5)
    text += fmt::format(", turned by roll, pitch, yaw {} deg", three(rpy, 4));
  return text;
}

}  // namespace

namespace {

// Frames of the offsets in use, each once.
std::vector<const WorkFrame*> named_frames(const std::vector<WorkFrame>& all) {
  std::vector<const WorkFrame*> frames;
  for (const WorkFrame& frame : all) {
    const bool known =
        std::any_of(frames.begin(), frames.end(), [&](const WorkFrame* f) { return f->name == frame.name; });
    if (!frame.name.empty() && !known) frames.push_back(&frame);
  }
  return frames;
}

// Whether another frame of the same offset has another pose: the program shifts, turns or sets it.
bool changes(const std::vector<WorkFrame>& all, const WorkFrame& frame) {
  return std::any_of(all.begin(), all.end(), [&](const WorkFrame& other) {
    return other.name == frame.name && difference(other.X_MW, frame.X_MW).norm() > 1e-9;
  });
}

}  // namespace

std::string work_in_words(const Machine& machine, const std::vector<WorkFrame>& frames) {
  std::string text;
  for (const WorkFrame* frame : named_frames(frames))
    text += fmt::format("{}{} puts the program's origin at {}{}.", text.empty() ? "" : " ", frame->name,
                        place(frame->X_MW), changes(frames, *frame) ? ", and the program changes it" : "");
  if (!text.empty()) return text;
  if (machine.work_is_machine_frame) return "Program coordinates are machine coordinates, as stated.";
  const std::string reason =
      machine.work.empty() ? "the machine file has no work offsets" : "no work offset is in use";
  return fmt::format("Program coordinates were taken as machine coordinates: {}.", reason);
}

namespace {

Datum datum_of(const Machine& machine, const WorkFrame& frame) {
  const auto offset = machine.work.find(frame.name);
  return offset != machine.work.end() ? offset->second.datum : Datum{};
}

std::string touched_in_words(const Datum& datum, const WorkFrame& frame) {
  return fmt::format(
      "The part was touched off with this machine at {} mm in coordinates of {}. The unloaded machine is off "
      "there by {} mm in the machine frame. Corrections are relative to this point.",
      three(*datum.touched_at / mm, 4), frame.name, three(frame.datum_shift / mm, 4));
}

// "G54", "G54 and G55", "G54, G55 and G56".
std::string names_of(const std::vector<const WorkFrame*>& frames) {
  std::string names;
  for (std::size_t i = 0; i < frames.size(); ++i)
    names += (i == 0 ? "" : i + 1 < frames.size() ? ", " : " and ") + frames[i]->name;
  return names;
}

// Offsets that count as true poses, with or without a stated datum.
std::string true_in_words(const std::vector<const WorkFrame*>& frames, bool stated) {
  if (frames.empty()) return "";
  return fmt::format("{} {}{} independently of this machine's errors{}.", names_of(frames),
                     frames.size() > 1 ? "were" : "was", stated ? " set" : " assumed to be set",
                     stated ? "" : ": no datum is stated");
}

}  // namespace

std::string datum_in_words(const Machine& machine, const std::vector<WorkFrame>& frames) {
  std::string text;
  std::vector<const WorkFrame*> stated, assumed;
  const auto add = [&](const std::string& sentence) {
    if (!sentence.empty()) text.append(text.empty() ? "" : " ").append(sentence);
  };
  for (const WorkFrame* frame : named_frames(frames)) {
    const Datum datum = datum_of(machine, *frame);
    if (datum.touched_at)
      add(touched_in_words(datum, *frame));
    else
      (datum.is_machine ? stated : assumed).push_back(frame);
  }
  add(true_in_words(stated, true));
  add(true_in_words(assumed, false));
  if (!text.empty() || machine.work_is_machine_frame) return text;
  return "The machine frame was assumed to be set independently of this machine's errors: no datum is "
         "stated.";
}

std::vector<UsedTool> used_tools(const Machine& machine, const std::vector<long>& numbers) {
  std::vector<UsedTool> tools;
  bool change = false;
  for (const long number : numbers) {
    const auto found = machine.tools.find(number);
    if (number == 0 || found == machine.tools.end()) continue;
    const Tool& tool = found->second;
    change = change || changes_model(machine, tool);
    UsedTool& used = tools.emplace_back(UsedTool{number, {}, {}, stiffness_phrase(tool)});
    if (tool.mass && weighs(machine)) used.stiffness += fmt::format(", {:.6g} kg", tool.mass->kg);
    if (tool.length) used.length_mm = *tool.length / mm;
    if (!tool.yields.empty()) used.radial_N_per_um = radial_stiffness(tool) / N_per_um;
  }
  return change ? tools : std::vector<UsedTool>{};
}

std::string tools_in_words(const std::vector<UsedTool>& tools, const std::vector<long>& numbers) {
  if (tools.empty()) return "";
  constexpr std::size_t most = 10;
  std::string text = "Tools in use: ";
  for (std::size_t i = 0; i < std::min(most, tools.size()); ++i)
    text += fmt::format("{}T{}, {}", i == 0 ? "" : "; ", tools[i].number, tools[i].stiffness);
  if (tools.size() > most) text += fmt::format("; and {} more", tools.size() - most);
  const bool others = tools.size() < numbers.size();
  return text + (others ? ". Moves with another tool, or an unknown one, use [tool], rigid." : ".");
}

namespace {

const char* own_corrections_of_arm(const Machine& machine) {
  switch (machine.kinematics) {
    case ControlKinematics::catalogue:
      return "the control's payload data; it computes with catalogue lengths (kinematics = \"catalogue\")";
    case ControlKinematics::factory:
      return "the control's payload data; it computes with calibrated lengths (kinematics = \"factory\"), "
             "and "
             "the errors in the machine file are those that they leave";
    case ControlKinematics::unstated:
      break;
  }
  return "the control's own corrections: absolute accuracy, payload data";
}

}  // namespace

namespace {

bool has_lost_motion(const Machine& machine) {
  return std::ranges::any_of(actuators(machine),
                             [](const Actuator& a) { return a.reversal.value_or(0) > 0; });
}

std::string backlash(const Machine& machine) {
  if (has_lost_motion(machine))
    return "friction: what it does beside the reversal values of the machine file";
  return turns_joints(machine)
             ? "backlash and friction: the tip differs where a joint reverses, on arms by some tenths of a mm"
             : "backlash and friction: the tip differs where an axis reverses";
}

}  // namespace

std::vector<std::string> not_modelled(const Machine& machine) {
  return {backlash(machine),
          machine.temperature
              ? "heat beside [thermal]: differences of temperature within the machine"
              : "heat: growth of spindle and frame, from the first part of the day to the last",
          machine.fixture ? "part and fixture beside [fixture]: places that are softer, clamping"
                          : "part and fixture: their bending and clamping",
          "dynamics: following error, rounded corners, chatter",
          turns_joints(machine)
              ? own_corrections_of_arm(machine)
              : "the control's own corrections: pitch, straightness and volumetric tables; errors that they "
                "remove must not be in the machine file"};
}

std::string thermal_in_words(const Machine& machine) {
  if (!machine.thermal) return "";
  if (!machine.temperature)
    return "The machine file has [thermal], but --temperature-C is not given: no thermal shift acts.";
  const ThermalShift at = thermal_shift(*machine.thermal, *machine.temperature);
  return fmt::format(
      "The machine was taken to be at {:.6g} degrees Celsius: it is shifted by {:.3g}, {:.3g}, "
      "{:.3g} um along x, y, z, and the spindle is {:.3g} um longer.",
      *machine.temperature, at.shift.x() / um + 0.0, at.shift.y() / um + 0.0, at.shift.z() / um + 0.0,
      at.growth / um + 0.0);
}

namespace {

bool has_tool_masses(const Machine& machine) {
  return std::ranges::any_of(machine.tools, [](const auto& entry) { return entry.second.mass.has_value(); });
}

}  // namespace

std::string gravity_in_words(const Machine& machine) {
  if (!weighs(machine)) return "";
  return fmt::format(
      "The machine's {:.6g} kg{} weigh on it, with and without a cut; the control's zero was set {}.",
      total_mass(machine), has_tool_masses(machine) ? ", and the masses of its tools," : "",
      machine.gravity.true_at_home ? "under this weight at home, where the perfect machine has no deviation"
                                   : "unloaded");
}

}  // namespace counterflex
