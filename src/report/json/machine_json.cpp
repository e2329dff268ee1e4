#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/machine_along.hpp"
#include "report/json/encoded.hpp"
#include "report/json/json_numbers.hpp"
#include "report/names.hpp"

namespace counterflex {
namespace {

constexpr int shown_digits = 9;               // as those of `analyze --json`
constexpr double same_conditioning = 1e-6;    // changes below it are rounding errors
constexpr std::size_t most_positions = 8192;  // of moving nodes: 128 kB

bool is_known(const MachinePlace& at) {
  return at.place.is_known();
}

/// A value for each place, NaN where it is not known.
template <typename Value>
std::string column(const MachineAlong& along, const Value& value) {
  std::vector<float> values;
  for (const MachinePlace& at : along.places)
    values.push_back(is_known(at) ? static_cast<float>(value(at)) : std::numeric_limits<float>::quiet_NaN());
  return encoded(values);
}

Json axes_json(const MachineAlong& along) {
  Json list = Json::array();
  for (std::size_t i = 0; i < along.axes.size(); ++i) {
    const Travel& travel = along.axes[i];
    const JointUnit unit = unit_of(travel.kind);
    const AxisValues range = i < along.ranges.size() ? along.ranges[i] : AxisValues{};
    list.push_back({{"name", travel.name},
                    {"unit", unit.name},
                    {"min", number(travel.min / unit.si, shown_digits)},
                    {"max", number(travel.max / unit.si, shown_digits)},
                    {"least", number(range.least / unit.si, shown_digits)},
                    {"largest", number(range.largest / unit.si, shown_digits)},
                    {"least_margin", number(range.margin / unit.si, shown_digits)},
                    {"margin_line", range.line},
                    {"values", column(along, [&](const MachinePlace& at) {
                       return at.place.shown[static_cast<Eigen::Index>(i)] / unit.si;
                     })}});
  }
  return list;
}

Json constant_json(const MachineAlong& along) {
  Json list = Json::array();
  for (const ConstantAxis& axis : along.constant)
    list.push_back({{"name", axis.name},
                    {"unit", unit_of(axis.kind).name},
                    {"value", number(axis.value / unit_of(axis.kind).si, shown_digits)}});
  return list;
}

/// Of the first place that has margins; nullptr without one.
const MachinePlace* first_with_margins(const MachineAlong& along) {
  const auto found = std::find_if(along.places.begin(), along.places.end(),
                                  [](const MachinePlace& at) { return at.place.margins.has_value(); });
  return found == along.places.end() ? nullptr : &*found;
}

Json margins_json(const MachineAlong& along) {
  Json list = Json::array();
  const MachinePlace* first = first_with_margins(along);
  for (std::size_t i = 0; first != nullptr && i < first->place.margins->size(); ++i)
    list.push_back({{"what", (*first->place.margins)[i].what},
                    {"values", column(along, [&](const MachinePlace& at) {
                       return at.place.margins ? (*at.place.margins)[i].angle / deg
                                               : std::numeric_limits<double>::quiet_NaN();
                     })}});
  return list;
}

Json least_margin_json(const MachineAlong& along) {
  if (!along.least_arm_margin || first_with_margins(along) == nullptr) return nullptr;
  return number(*along.least_arm_margin / deg, shown_digits);
}

Json conditioning_json(const MachineAlong& along) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const MachinePlace& at : along.places)
    if (is_known(at)) {
      least = std::min(least, at.conditioning);
      most = std::max(most, at.conditioning);
    }
  if (!(most - least > same_conditioning) || first_with_margins(along) != nullptr) return nullptr;
  return column(along, [](const MachinePlace& at) { return at.conditioning; });
}

bool has_shape_of(const std::vector<SkeletonLine>& a, const std::vector<SkeletonLine>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SkeletonLine& x, const SkeletonLine& y) { return x.size() == y.size(); });
}

/// The positions of one node (0.1 mm in mm) at all places; NaN where they are not known.
using Positions = std::vector<Vector3>;

Positions positions_of(const MachineAlong& along, const std::vector<SkeletonLine>& shape, std::size_t line,
                       std::size_t node) {
  Positions positions;
  for (const MachinePlace& at : along.places)
    positions.push_back(has_shape_of(at.lines, shape)
                            ? Vector3((at.lines[line][node] / (0.1 * mm)).array().round() / 10)
                            : Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
  return positions;
}

bool stays(const Positions& positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [&](const Vector3& p) { return p == positions.front(); });
}

Json node_json(const Positions& positions, std::size_t every) {
  if (stays(positions)) return numbers(positions.front(), 1);
  std::vector<float> values;
  for (std::size_t i = 0; i < positions.size(); i += every)
    for (const double x : positions[i]) values.push_back(static_cast<float>(x));
  return encoded(values);
}

Json skeleton_json(const MachineAlong& along) {
  const auto first = std::find_if(along.places.begin(), along.places.end(), is_known);
  if (first == along.places.end()) return nullptr;
  std::vector<std::vector<Positions>> lines(first->lines.size());
  std::size_t moving = 0;
  for (std::size_t l = 0; l < lines.size(); ++l)
    for (std::size_t node = 0; node < first->lines[l].size(); ++node) {
      lines[l].push_back(positions_of(along, first->lines, l, node));
      if (!stays(lines[l].back())) ++moving;
    }
  const std::size_t every = 1 + moving * along.places.size() / (most_positions + 1);
  Json list = Json::array();
  for (const std::vector<Positions>& line : lines) {
    Json nodes = Json::array();
    for (const Positions& positions : line) nodes.push_back(node_json(positions, every));
    list.push_back(std::move(nodes));
  }
  return {{"every", every}, {"lines", std::move(list)}};
}

}  // namespace

std::string machine_json(const MachineAlong& along) {
  std::vector<double> s_mm;
  std::vector<std::int32_t> lines;
  for (const MachinePlace& at : along.places) {
    s_mm.push_back(at.s / mm);
    lines.push_back(at.line);
  }
  const Json document = {{"s_mm", encoded(s_mm)},
                         {"line", encoded(lines)},
                         {"axes", axes_json(along)},
                         {"constant", constant_json(along)},
                         {"margins", margins_json(along)},
                         {"refused_below_deg", least_margin_json(along)},
                         {"conditioning", conditioning_json(along)},
                         {"skeleton", skeleton_json(along)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace counterflex
