#include <fmt/format.h>

#include <cassert>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/coupon.hpp"
#include "identify/coupon/sheet_columns.hpp"

namespace counterflex {
namespace {

std::string half_of(const CouponQuantity& quantity) {
  return quantity.is_corrected ? "corrected" : "not corrected";
}

std::string place_columns(const std::vector<Actuator>& all) {
  std::string text = "place_of,half,quantity,tool";
  for (std::size_t i = 0; i < all.size(); ++i) text += fmt::format(",{}", value_column(all[i], i));
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].reversal) text += fmt::format(",{}", direction_column(i));
  return text + ",fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm,x_mm,y_mm,z_mm,wx,wy,wz,wr\n";
}

/// `share`: of a deviation of the tool's radius, for one place.
std::string place_line(const std::vector<Actuator>& all, const std::string& row, const CommandedState& state,
                       const FeaturePlace& place, double share) {
  std::string text = fmt::format("{},{}", row, state.tool);
  for (Eigen::Index i = 0; i < state.shown.size(); ++i) {
    const bool turns = all[static_cast<std::size_t>(i)].joint.kind == JointKind::revolute;
    text += fmt::format(",{:.{}f}", state.shown[i] / (turns ? deg : mm), turns ? 8 : 6);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].reversal) text += fmt::format(",{}", state.directions.of(i));
  for (const double value : state.F) text += fmt::format(",{:.7g}", value);
  for (const double value : place.p_MT) text += fmt::format(",{:.6f}", value / mm);
  for (const double value : place.weight) text += fmt::format(",{:.9g}", rounded(value, 12));
  return text + fmt::format(",{:.9g}\n", share);
}

}  // namespace

std::string coupon_sheet(const Machine& machine, const Coupon& coupon, const Measurements& rows,
                         const std::vector<CouponPrediction>& predictions, double sigma) {
  assert(rows.rows.size() == coupon.quantities.size() + 1 && predictions.size() == rows.rows.size());
  const std::vector<Actuator> all = actuators(machine);
  std::string text(sheet_mark);
  text +=
      "\n# Write what was measured into measured_mm. Rows without a value are skipped.\n"
      "# Sizes need no alignment. Align positions by a best fit to the nominal values of the corrected "
      "half.\n"
      "# The diameter of the tool distinguishes a cutter that is too large from a machine that deflects.\n"
      "feature,half,quantity,nominal_mm,predicted_mm,band_mm,measured_mm,sigma_um\n";
  std::vector<std::string> names;
  for (std::size_t k = 0; k < coupon.quantities.size(); ++k) {
    const CouponQuantity& quantity = coupon.quantities[k];
    names.push_back(fmt::format("{},{},{}", quantity.feature, half_of(quantity), quantity.name));
    text += fmt::format("{},{:.4f},{:.4f},{:.4f},,{:.3g}\n", names.back(), quantity.nominal_mm,
                        quantity.nominal_mm + predictions[k].deviation / mm, 2 * predictions[k].sigma / mm,
                        sigma / um);
  }
  names.push_back("tool,,diameter_mm");
  text += fmt::format("{},{:.4f},{:.4f},,,{:.3g}\n", names.back(), coupon.diameter_mm, coupon.diameter_mm,
                      sigma / um);
  text +=
      "# Where the quantities come from: actuators and forces at the places of their cuts. Do not change "
      "these "
      "lines.\n" +
      place_columns(all);
  for (std::size_t k = 0; k < rows.rows.size(); ++k) {
    const Measurement& row = rows.rows[k];
    for (std::size_t i = 0; i < row.places.size(); ++i)
      text += place_line(all, names[k], row.states[i], row.places[i],
                         row.offset_share / static_cast<double>(row.places.size()));
  }
  return text;
}

}  // namespace counterflex
