#include <Eigen/QR>
#include <cmath>

#include "counterflex/identify/coupon.hpp"
#include "identify/fit/residuals.hpp"
#include "identify/prior.hpp"

namespace counterflex {
namespace {

/// The parameters that are uncertain, and their deviations before the coupon is measured.
struct UncertainParameters {
  std::vector<std::size_t> varied;
  std::vector<double> sigma;
};

UncertainParameters prior_parameters(const Machine& machine) {
  UncertainParameters result;
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double sigma = prior_deviation(machine, all[i]).sigma;
    if (sigma == 0) continue;
    result.varied.push_back(i);
    result.sigma.push_back(sigma);
  }
  return result;
}

/// A, scaled so that columns of lengths and of angles count alike.
Eigen::MatrixXd scaled_columns(const Eigen::MatrixXd& A, Eigen::VectorXd& scale) {
  scale = A.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  return A * scale.asDiagonal();
}

}  // namespace

std::vector<CouponPrediction> predict_coupon(const Machine& machine, const Coupon& coupon,
                                             const Measurements& rows, int threads) {
  const UncertainParameters uncertain = prior_parameters(machine);
  const States states = nominal_states(machine, rows, threads);
  std::vector<Configuration> loaded;
  const std::vector<Response> at = responses(machine, uncertain.varied, states, threads, loaded);
  const auto count = static_cast<Eigen::Index>(rows.rows.size()),
             varied = static_cast<Eigen::Index>(uncertain.varied.size());
  Eigen::VectorXd d(count);
  Eigen::MatrixXd J(count, varied), frame(count, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Measurement& row = rows.rows[k];
    const RowResidual found =
        residual(row, MeasurementKind::cmm_feature, {}, &at[states.first[k]], &states.X_MT[states.first[k]]);
    if (!found.is_found) return {};
    d[i] = found.r[0] * row.sigma;
    J.row(i) = found.J_p.row(0) * row.sigma;
    frame.row(i) = found.J_s.row(0).head<6>() * row.sigma;
  }
  // The frame that fits the corrected half best: d + frame * x is small there.
  std::vector<Eigen::Index> corrected;
  for (std::size_t k = 0; k < coupon.quantities.size(); ++k)
    if (coupon.quantities[k].is_corrected) corrected.push_back(static_cast<Eigen::Index>(k));
  Eigen::VectorXd scale;
  const Eigen::MatrixXd A = scaled_columns(frame(corrected, Eigen::all), scale);
  const Eigen::MatrixXd fit =
      frame * scale.asDiagonal() * A.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::VectorXd in_frame = d - fit * d(corrected);
  const Eigen::MatrixXd J_in_frame = J - fit * J(corrected, Eigen::all);
  const Eigen::Map<const Eigen::RowVectorXd> sigma(uncertain.sigma.data(), varied);
  std::vector<CouponPrediction> result;
  for (Eigen::Index i = 0; i < count; ++i)
    result.push_back({in_frame[i], J_in_frame.row(i).cwiseProduct(sigma).norm()});
  return result;
}

}  // namespace counterflex
