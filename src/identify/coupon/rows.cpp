#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <map>

#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/coupon.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_of_cut = 8;  // places of one cut in a row: more change nothing

/// Some of the places, evenly spread; each represents those that are left out.
std::vector<CouponPlace> spread(const std::vector<CouponPlace>& all) {
  if (all.size() <= most_of_cut) return all;
  std::vector<CouponPlace> some;
  for (std::size_t k = 0; k < most_of_cut; ++k) {
    const std::size_t begin = k * all.size() / most_of_cut, end = (k + 1) * all.size() / most_of_cut;
    CouponPlace place = all[(begin + end) / 2];
    place.way = 0;
    for (std::size_t i = begin; i < end; ++i) place.way += all[i].way;
    some.push_back(std::move(place));
  }
  return some;
}

void add_place(const CouponPlace& place, const Vector3& weight, Measurement& row) {
  row.states.push_back(place.state);
  row.places.push_back({place.p_MT, weight});
}

void add_means(const CouponQuantity& quantity, const std::map<int, std::vector<CouponPlace>>& places,
               const Pose& X_MW, Measurement& row) {
  for (const CouponCut& cut : quantity.cuts) {
    const std::vector<CouponPlace>& along = places.at(cut.line);
    double way = 0;
    for (const CouponPlace& place : along) way += place.way;
    for (const CouponPlace& place : along)
      add_place(place, cut.share * place.way / way * (X_MW.R * cut.direction), row);
  }
}

/// The circle of least squares of radial deviations d: d = c_x cos + c_y sin + r. The weights of d are a row
/// of the pseudo-inverse.
void add_circle_fit(const CouponQuantity& quantity, const std::vector<CouponPlace>& along, const Pose& X_MW,
                    Measurement& row) {
  const auto count = static_cast<Eigen::Index>(along.size());
  const Vector3 centre = X_MW * Vector3(quantity.centre_mm * mm);
  Eigen::MatrixXd A(count, 3);
  std::vector<Vector3> radial;
  for (Eigen::Index k = 0; k < count; ++k) {
    Vector3 n = X_MW.R.transpose() * (along[static_cast<std::size_t>(k)].p_MT - centre);
    n.z() = 0;
    n.normalize();
    A.row(k) << n.x(), n.y(), 1;
    radial.push_back(X_MW.R * n);
  }
  const Eigen::MatrixXd inverse = A.completeOrthogonalDecomposition().pseudoInverse();
  for (Eigen::Index k = 0; k < count; ++k) {
    const double weight = quantity.fit == CouponFit::circle_x   ? inverse(0, k)
                          : quantity.fit == CouponFit::circle_y ? inverse(1, k)
                                                                : 2 * inverse(2, k);
    add_place(along[static_cast<std::size_t>(k)], weight * radial[static_cast<std::size_t>(k)], row);
  }
}

}  // namespace

Measurements coupon_rows(const Coupon& coupon, const std::vector<CouponPlace>& places, const Pose& X_MW) {
  assert(!places.empty());
  std::map<int, std::vector<CouponPlace>> by_line;
  for (const CouponPlace& place : places) by_line[place.line].push_back(place);
  for (auto& [line, along] : by_line) along = spread(along);
  Measurements rows;
  rows.sessions.push_back({"coupon", MeasurementKind::cmm_feature, true, Pose{}});
  for (const CouponQuantity& quantity : coupon.quantities) {
    Measurement row;
    row.sigma = um;
    row.offset_share = quantity.radius_share;
    if (quantity.fit == CouponFit::mean)
      add_means(quantity, by_line, X_MW, row);
    else
      add_circle_fit(quantity, by_line.at(quantity.cuts.front().line), X_MW, row);
    rows.rows.push_back(std::move(row));
  }
  Measurement tool;
  tool.sigma = um;
  tool.offset_share = 2;
  add_place(places.front(), Vector3::Zero(), tool);
  rows.rows.push_back(std::move(tool));
  return rows;
}

}  // namespace counterflex
