#include "identify/fit/residuals.hpp"

#include <cmath>

namespace counterflex {
namespace {

using Tangents = Eigen::Matrix<double, 6, Eigen::Dynamic>;

RowResidual tracker(const Measurement& row, bool has_orientation, const SessionFrames& frames,
                    const Response& at) {
  const Matrix3& R_SM = frames.X_SM.R;
  const Vector3 arm = at.X_MT.R * frames.X_TB.p;  // from the tip to the probe, axes of M
  const Vector3 p_S = frames.X_SM * (at.X_MT.p + arm);
  const Matrix3 R_ST = R_SM * at.X_MT.R;
  const auto v = at.tangents.topRows<3>(), w = at.tangents.bottomRows<3>();
  RowResidual out;
  out.distances = 3;
  const int size = has_orientation ? 6 : 3;
  out.r.setZero(size);
  out.J_p.setZero(size, at.tangents.cols());
  out.J_s.setZero(size, session_unknowns);
  out.r.head<3>() = (p_S - row.X.p) / row.sigma;
  out.J_p.topRows<3>() = R_SM * (v - skew(arm) * w) / row.sigma;
  out.J_s.block<3, 3>(0, 0) = Matrix3::Identity() / row.sigma;
  out.J_s.block<3, 3>(0, 3) = -skew(p_S - frames.X_SM.p) / row.sigma;
  out.J_s.block<3, 3>(0, 6) = R_ST / row.sigma;
  if (!has_orientation) return out;
  const Vector3 turned = log_so3(R_ST * frames.X_TB.R * row.X.R.transpose());
  const Matrix3 J = left_jacobian_inverse(turned) / row.sigma_angle;
  out.r.tail<3>() = turned / row.sigma_angle;
  out.J_p.bottomRows<3>() = J * R_SM * w;
  out.J_s.block<3, 3>(3, 3) = J;
  out.J_s.block<3, 3>(3, 9) = J * R_ST;
  return out;
}

/// A row with one component: value `predicted`, tangents by parameters, and where it has them by unknowns.
RowResidual scalar(const Measurement& row, double predicted, const Eigen::RowVectorXd& J_p) {
  RowResidual out;
  out.distances = 1;
  out.r = Eigen::VectorXd::Constant(1, (predicted - row.value) / row.sigma);
  out.J_p = J_p / row.sigma;
  out.J_s.setZero(1, session_unknowns);
  return out;
}

RowResidual plane(const Measurement& row, const SessionFrames& frames, const Response& at) {
  const Vector3 normal = frames.X_SM.R.row(2), p_S = frames.X_SM * at.X_MT.p;
  RowResidual out = scalar(row, p_S.z(), normal.transpose() * at.tangents.topRows<3>());
  const Vector3 arm = p_S - frames.X_SM.p;
  out.J_s(0, 2) = 1 / row.sigma;
  out.J_s.block<1, 3>(0, 3) = -skew(arm).row(2) / row.sigma;
  return out;
}

RowResidual bar(const Measurement& row, const Response* at) {
  const Vector3 between = at[0].X_MT.p - at[1].X_MT.p;
  const Vector3 direction = between.normalized();
  return scalar(row, between.norm(),
                direction.transpose() * (at[0].tangents.topRows<3>() - at[1].tangents.topRows<3>()));
}

/// A sum of weighted deviations in the frame of the part, and what the tool's radius adds.
RowResidual feature(const Measurement& row, const SessionFrames& frames, const Response* at) {
  double predicted = row.offset_share * frames.offset;
  Eigen::RowVectorXd J_p = Eigen::RowVectorXd::Zero(at[0].tangents.cols());
  Eigen::RowVectorXd J_s = Eigen::RowVectorXd::Zero(session_unknowns);
  for (std::size_t k = 0; k < row.places.size(); ++k) {
    const auto& [p_MT, weight] = row.places[k];
    const Vector3 p_S = frames.X_SM * at[k].X_MT.p;
    predicted += weight.dot(p_S - p_MT);
    J_p += weight.transpose() * frames.X_SM.R * at[k].tangents.topRows<3>();
    J_s.head<3>() += weight.transpose();
    J_s.segment<3>(3) -= weight.transpose() * skew(p_S - frames.X_SM.p);
  }
  J_s[12] = row.offset_share;
  RowResidual out = scalar(row, predicted, J_p);
  out.J_s = J_s / row.sigma;
  return out;
}

/// How far the point moves that the gauge touches, and what friction adds.
RowResidual push(const Measurement& row, const SessionFrames& frames, const Response* at) {
  double predicted = row.offset_share * frames.offset;
  Eigen::RowVectorXd J_p = Eigen::RowVectorXd::Zero(at[0].tangents.cols());
  for (const int k : {0, 1}) {
    const Vector3 arm = at[k].X_MT.R * row.gauge;
    const Eigen::RowVector3d along = (k == 0 ? 1 : -1) * row.direction.transpose();
    predicted += along * (at[k].X_MT.p + arm);
    J_p += along * (at[k].tangents.topRows<3>() - skew(arm) * at[k].tangents.bottomRows<3>());
  }
  RowResidual out = scalar(row, predicted, J_p);
  out.J_s(0, 12) = row.offset_share / row.sigma;
  return out;
}

/// The angle between two directions of motion, less a right angle.
RowResidual squareness(const Measurement& row, const Response* at) {
  const Vector3 a = at[1].X_MT.p - at[0].X_MT.p, b = at[3].X_MT.p - at[2].X_MT.p;
  const Vector3 u = a.normalized(), v = b.normalized();
  const double cosine = u.dot(v), sine = u.cross(v).norm();
  const double predicted = std::atan2(sine, cosine) - pi / 2;
  const Tangents da = at[1].tangents - at[0].tangents, db = at[3].tangents - at[2].tangents;
  const Eigen::RowVectorXd d_cosine = (v - cosine * u).transpose() / a.norm() * da.topRows<3>() +
                                      (u - cosine * v).transpose() / b.norm() * db.topRows<3>();
  return scalar(row, predicted, -d_cosine / sine);
}

/// How far the tip is from its nominal place along a linear axis, or about a rotary one (m, rad).
struct AxisError {
  double value;
  Eigen::RowVectorXd tangents;
};

AxisError axis_error(const Measurement& row, const Response& at, const Pose& X_MT_nominal, bool turns) {
  const Eigen::RowVector3d axis = row.direction.transpose();
  if (!turns) return {axis * (at.X_MT.p - X_MT_nominal.p), axis * at.tangents.topRows<3>()};
  const Vector3 turned = log_so3(at.X_MT.R * X_MT_nominal.R.transpose());
  return {axis * turned, axis * left_jacobian_inverse(turned) * at.tangents.bottomRows<3>()};
}

/// A row with an unknown offset of its session.
RowResidual with_offset(const Measurement& row, double predicted, const Eigen::RowVectorXd& J_p,
                        const SessionFrames& frames) {
  RowResidual out = scalar(row, predicted + frames.offset, J_p);
  out.J_s(0, 12) = 1 / row.sigma;
  return out;
}

RowResidual scale(const Measurement& row, const Response* at, const Pose* X_MT_nominal) {
  const Vector3 moved = at[1].X_MT.p - at[0].X_MT.p;
  const double commanded = (X_MT_nominal[1].p - X_MT_nominal[0].p).norm();
  const Eigen::RowVector3d direction = moved.normalized().transpose() / commanded;
  return scalar(row, moved.norm() / commanded - 1,
                direction * (at[1].tangents.topRows<3>() - at[0].tangents.topRows<3>()));
}

}  // namespace

std::vector<int> unknowns_of(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::tracker_point:
      return {0, 1, 2, 3, 4, 5, 6, 7, 8};
    case MeasurementKind::tracker_pose:
      return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    case MeasurementKind::plane_contact:
      return {2, 3, 4};
    case MeasurementKind::axis_position:
    case MeasurementKind::axis_table:
    case MeasurementKind::clamped_torque:
      return {12};
    case MeasurementKind::cmm_feature:  // the frame of the part, and the radius of the tool
      return {0, 1, 2, 3, 4, 5, 12};
    default:
      return {};
  }
}

std::vector<int> unknowns_of(const Session& session) {
  if (session.has_loading && session.has_unloading) return {12};
  if (!session.has_known_frame) return unknowns_of(session.kind);
  const bool is_tracker =
      session.kind == MeasurementKind::tracker_point || session.kind == MeasurementKind::tracker_pose;
  return is_tracker && session.probe_sigma > 0 ? std::vector<int>{6, 7, 8} : std::vector<int>{};
}

SessionFrames moved(const SessionFrames& frames, const Eigen::Matrix<double, session_unknowns, 1>& step) {
  return {moved(frames.X_SM, Vector6(step.head<6>())), moved(frames.X_TB, Vector6(step.segment<6>(6))),
          frames.offset + step[12]};
}

RowResidual residual(const Measurement& row, MeasurementKind kind, const SessionFrames& frames,
                     const Response* at, const Pose* X_MT_nominal) {
  for (std::size_t k = 0; k < row.states.size(); ++k)
    if (at[k].status != Status::converged) {
      RowResidual none;
      none.is_found = false;
      return none;
    }
  switch (kind) {
    case MeasurementKind::tracker_point:
      return tracker(row, false, frames, at[0]);
    case MeasurementKind::tracker_pose:
      return tracker(row, true, frames, at[0]);
    case MeasurementKind::plane_contact:
      return plane(row, frames, at[0]);
    case MeasurementKind::length_bar:
      return bar(row, at);
    case MeasurementKind::squareness:
      return squareness(row, at);
    case MeasurementKind::cmm_feature:
      return feature(row, frames, at);
    case MeasurementKind::static_push:
    case MeasurementKind::hung_weight:
      return push(row, frames, at);
    case MeasurementKind::axis_position:
      return with_offset(row, row.direction.dot(at[0].X_MT.p - X_MT_nominal[0].p),
                         row.direction.transpose() * at[0].tangents.topRows<3>(), frames);
    case MeasurementKind::axis_table: {
      const AxisError error = axis_error(row, at[0], X_MT_nominal[0], !row.is_length);
      return with_offset(row, error.value, error.tangents, frames);
    }
    case MeasurementKind::reversal: {
      const AxisError up = axis_error(row, at[0], X_MT_nominal[0], !row.is_length),
                      down = axis_error(row, at[1], X_MT_nominal[1], !row.is_length);
      return scalar(row, down.value - up.value, down.tangents - up.tangents);
    }
    case MeasurementKind::scale:
      return scale(row, at, X_MT_nominal);
    case MeasurementKind::clamped_torque:
      return with_offset(row, at[0].turn, at[0].turn_tangents, frames);
    case MeasurementKind::ballbar:
    case MeasurementKind::repeat:
      break;
  }
  return {};
}

}  // namespace counterflex
