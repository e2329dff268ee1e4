#pragma once
/// A picture of a machine.
#include <string>
#include <string_view>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// In the title of each drawing.
inline constexpr std::string_view drawing_mark = "Machine at home";

/// The machine at home as SVG: front, side and top view, in one scale, with the names of its axes, springs
/// and masses, its work frames and the tool tip. `model` is that of `machine`.
std::string machine_drawing(const Machine& machine, const Model& model);

}  // namespace counterflex
