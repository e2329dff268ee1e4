#pragma once
/// Tools that bend: the machine with one of them in its spindle, and what such a tool is.
#include <string>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Two compliances along the tip's x and y of stiffness `k` (N/m, positive): axially and in tilt the tool is
/// rigid.
std::vector<Element> radial_tool(double k);

/// The bending of what sticks out of the holder: a cantilever of 0.8 of the diameter, along -z of the tip's
/// axes. `diameter` and `stickout` in m, positive.
///
/// Carbide: E 600 GPa, Poisson's ratio 0.22 (K10 to K20 grades, 6 to 10 % Co: 580 to 630 GPa in makers' data
/// sheets). Steel, HSS too: E 210 GPa, 0.3. The 0.8 is the usual equivalent diameter of a fluted end mill.
/// Source: Kops, Vo, "Determination of the equivalent diameter of an end mill based on its compliance", CIRP
/// Annals 39 (1990).
Spring cantilever_tool(double diameter, double stickout, ToolMaterial material);

/// Force over displacement at the tip (N/m) in the direction of x or y in which it yields most; infinite for
/// a rigid tool.
double radial_stiffness(const Tool& tool);

/// The tool's tip in the platform frame: [spindle] moved by the tool's length along -z; [tool] where one of
/// them is missing.
Pose tip_of(const Machine& machine, const Tool& tool);

/// Whether the machine with this tool is another than the machine with [tool].
bool changes_model(const Machine& machine, const Tool& tool);

/// The machine with `tool` in its spindle: its tip, and what yields as the last elements before it. A machine
/// of several chains becomes one chain that begins with a group of them; actuators keep their numbers, the
/// platform is then the tip.
Machine with_tool(const Machine& machine, const Tool& tool);

/// "stiffness from a carbide cantilever of 0.8 diameter core, 25 mm long: 12.3 N/um at its tip"; what else
/// it is from; "rigid".
std::string stiffness_phrase(const Tool& tool);

}  // namespace counterflex
