#pragma once
/// Which radius of the tool a contour under G41 or G42 lets through, and what dividing its blocks leaves of
/// it.
///
/// At an inner corner the control shortens both blocks to where the tool touches the other one. A block, or a
/// piece of one, that is shorter than that is refused by controls, or cut wrongly.
#include <vector>

#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/curve.hpp"

namespace counterflex {

/// A line or an arc beside which the tool goes, in X and Y (mm).
struct ContourWay {
  Curve curve;
  CutterSide side = CutterSide::left;
  bool is_divided = false;
  double first_mm = 0, last_mm = 0;  ///< of a divided one: its pieces at its start and end
  std::size_t move = 0;              ///< index into Program::moves
};

/// Whether the tool is inside of the corner between two ways.
bool is_inner_corner(const Curve& before, const Curve& after, CutterSide side);

/// A radius of the tool (mm), and the way that lets no larger one through.
struct ContourRadius {
  double mm = 0;
  std::size_t way = 0;
};

/// No tool has a larger radius (mm).
inline constexpr double largest_tool_radius_mm = 250;

/// The largest radius that lets a control follow `ways`, one behind the other, as far as their corners and
/// inner arcs decide it; at most `largest_tool_radius_mm`. Whether the tool touches other parts of the
/// contour is not examined. `by_pieces`: of those that are divided, the pieces at their ends must be long
/// enough.
ContourRadius largest_radius(const std::vector<ContourWay>& ways, bool by_pieces);

/// The contours of a window whose written blocks let through a smaller radius than the programmed ones.
/// `edits`: of its moves, in their order.
std::vector<NarrowedContour> narrowed_contours(const Job& job, const std::vector<MoveEdit>& edits);

}  // namespace counterflex
