#pragma once
/// The deviation along the path and what it is made of, as a picture for papers and pages.
#include <string>
#include <string_view>

#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

/// The title of every picture begins so.
inline constexpr std::string_view plot_mark = "Deviation along the path";

/// A plot of `curves`, those of the run of `report`: the components of the deviation before over cutting path
/// length, each with its causes alone (geometry, load and, with masses, gravity), their superposition, and
/// all acting together; below, where there is a corrected program, the size of the model residual and the
/// tolerance. Lengths in the units in which reports show them. A standalone SVG of 800 px by what it takes,
/// on white, without scripts; the same curves give the same bytes. Where the path has more places than the
/// plot has columns each curve is a band from the least to the largest value of a column: no peak is lost.
/// Allocates; does not throw.
std::string to_svg(const PathCurves& curves, const RunReport& report);

}  // namespace counterflex
