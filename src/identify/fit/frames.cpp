#include "identify/fit/frames.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

namespace counterflex {
namespace {

constexpr int rounds = 30;         // of weights
constexpr double smallest = 1e-5;  // m: errors below it have the same weight
/// Of the expected position of a probe against that of all rows: misfits of 1 mm, a lever of 0.3 m.
constexpr double weight_of_expected = 1e-5;

/// Weights of a fit by sums of distances, not of squares: a gross error counts little.
std::vector<double> weights_of(const std::vector<Vector3>& errors) {
  std::vector<double> weights;
  for (const Vector3& error : errors) weights.push_back(1 / std::max(error.norm(), smallest));
  return weights;
}

/// X with to = X * from in the weighted mean. Source: Umeyama, "Least-squares estimation of transformation
/// parameters between two point patterns" (1991).
Pose match_points(const std::vector<Vector3>& from, const std::vector<Vector3>& to,
                  const std::vector<double>& weights) {
  Vector3 mean_from = Vector3::Zero(), mean_to = Vector3::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sum += weights[i];
    mean_from += weights[i] * from[i];
    mean_to += weights[i] * to[i];
  }
  mean_from /= sum;
  mean_to /= sum;
  Matrix3 M = Matrix3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i)
    M += weights[i] * (to[i] - mean_to) * (from[i] - mean_from).transpose();
  const Eigen::JacobiSVD<Matrix3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 sign = Matrix3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Matrix3 R = svd.matrixU() * sign * svd.matrixV().transpose();
  return {R, mean_to - R * mean_from};
}

/// The rotation nearest to a matrix.
Matrix3 nearest_rotation(const Matrix3& M) {
  const Eigen::JacobiSVD<Matrix3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 sign = Matrix3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

/// R_SM and R_TB with measured = R_SM R_MT R_TB: the dominant singular vectors of a sum of Kronecker
/// products. Source: Shah, "Solving the robot-world/hand-eye calibration problem using the Kronecker
/// product", Journal of Mechanisms and Robotics 5 (2013).
void match_rotations(const std::vector<const Measurement*>& rows, const std::vector<Pose>& X_MT,
                     SessionFrames& frames) {
  // measured R_TB' = R_SM R_MT: vec(R_SM) = (R_MT x measured) vec(R_TB') for each row.
  Eigen::Matrix<double, 9, 9> K = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) K.block<3, 3>(3 * a, 3 * b) += X_MT[i].R(a, b) * rows[i]->X.R;
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> svd(K, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix<double, 9, 1> u = svd.matrixU().col(0), v = svd.matrixV().col(0);
  Matrix3 R_SM = Eigen::Map<const Matrix3>(u.data()), R_BT = Eigen::Map<const Matrix3>(v.data());
  if (R_SM.determinant() < 0) R_SM = -R_SM;
  if (R_BT.determinant() < 0) R_BT = -R_BT;
  frames.X_SM.R = nearest_rotation(R_SM);
  frames.X_TB.R = nearest_rotation(R_BT).transpose();
}

/// The probe's position and the base's with known R_SM: p_S = R_SM (p + R t) + b is linear in t and b.
/// A tip that hardly turns does not determine the probe: it then stays near `expected` in the tip's frame.
void match_offsets(const std::vector<const Measurement*>& rows, const std::vector<Pose>& X_MT,
                   const std::vector<double>& weights, const Vector3& expected, SessionFrames& frames) {
  Eigen::Matrix<double, 6, 6> N = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 rhs = Vector6::Zero();
  for (int k = 0; k < 3; ++k) {
    N(k, k) = weight_of_expected * std::accumulate(weights.begin(), weights.end(), 0.0);
    rhs[k] = N(k, k) * expected[k];
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::Matrix<double, 3, 6> J;
    J << frames.X_SM.R * X_MT[i].R, Matrix3::Identity();
    N += weights[i] * J.transpose() * J;
    rhs += weights[i] * J.transpose() * (rows[i]->X.p - frames.X_SM.R * X_MT[i].p);
  }
  const Vector6 x = Eigen::CompleteOrthogonalDecomposition<Matrix6>(N).solve(rhs);
  frames.X_TB.p = x.head<3>();
  frames.X_SM.p = x.tail<3>();
}

SessionFrames tracker_frames(const Session& session, const std::vector<const Measurement*>& rows,
                             const std::vector<Pose>& X_MT) {
  SessionFrames frames{Pose{}, session.X_TB, 0};
  std::vector<double> weights(rows.size(), 1.0);
  const bool has_orientation = session.kind == MeasurementKind::tracker_pose;
  if (has_orientation) match_rotations(rows, X_MT, frames);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vector3> from, to, errors;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      from.push_back(X_MT[i] * frames.X_TB.p);
      to.push_back(rows[i]->X.p);
    }
    if (!has_orientation) frames.X_SM = match_points(from, to, weights);
    match_offsets(rows, X_MT, weights, session.X_TB.p, frames);
    for (std::size_t i = 0; i < rows.size(); ++i)
      errors.push_back(frames.X_SM * (X_MT[i] * frames.X_TB.p) - to[i]);
    weights = weights_of(errors);
  }
  return frames;
}

/// z of S is the normal of the plane through the touched places, S on it.
SessionFrames plane_frames(const std::vector<Pose>& X_MT) {
  Vector3 mean = Vector3::Zero();
  for (const Pose& X : X_MT) mean += X.p / static_cast<double>(X_MT.size());
  Matrix3 M = Matrix3::Zero();
  for (const Pose& X : X_MT) M += (X.p - mean) * (X.p - mean).transpose();
  const Eigen::JacobiSVD<Matrix3> svd(M, Eigen::ComputeFullU);
  Matrix3 R_MS;
  R_MS << svd.matrixU().col(0), svd.matrixU().col(1), svd.matrixU().col(0).cross(svd.matrixU().col(1));
  return {inverse(Pose{R_MS, mean}), Pose{}, 0};
}

}  // namespace

SessionFrames first_frames(const Session& session, const std::vector<const Measurement*>& rows,
                           const std::vector<Pose>& X_MT) {
  if (session.has_known_frame) return {Pose{}, session.X_TB, 0};
  switch (session.kind) {
    case MeasurementKind::tracker_point:
    case MeasurementKind::tracker_pose:
      return tracker_frames(session, rows, X_MT);
    case MeasurementKind::plane_contact:
      return plane_frames(X_MT);
    case MeasurementKind::clamped_torque:
      return {Pose{}, Pose{}, rows[rows.size() / 2]->value};
    default:
      return {};
  }
}

}  // namespace counterflex
