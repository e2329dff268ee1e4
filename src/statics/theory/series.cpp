#include "statics/theory/series.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "statics/model/part.hpp"

namespace counterflex {
namespace {

// Axes of the columns of a part between the frames `X` and `X_after`, and where they pass.
void place_columns(const Series& series, const Part& part, const SeriesState& state, const Stage& stage,
                   const Pose& X, const Pose& X_after, SeriesWork& work) {
  const int c = part.column;
  if (columns_of(part) == 6) {
    const bool spring = part.kind == PartKind::spring;
    work.v.middleCols<3>(c) = X.R;
    work.w.middleCols<3>(c).setZero();
    work.w.middleCols<3>(c + 3) = spring ? Matrix3(X.R * left_jacobian(state.x.segment<3>(c + 3))) : X.R;
    work.point.middleCols<3>(c + 3).colwise() = X_after.p;
  } else if (series.screws[c]) {
    const JointMotion motion = actuator_motion(part, state, stage);
    work.along.col(c) = X.R * motion.v;
    work.w.col(c) = X.R * motion.w;
    work.point.col(c) = X_after.p;
  } else if (part.joint.kind == JointKind::prismatic) {
    work.v.col(c) = X.R * part.joint.axis;
    work.w.col(c).setZero();
  } else {
    work.w.col(c) = X.R * part.joint.axis;
    work.point.col(c) = X.p;
  }
}

// Frames from start to end: axes and points of all columns, and where the end is.
void place(const Series& series, const SeriesState& state, const Stage& stage, SeriesWork& work) {
  Pose X;
  int mass = 0;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::mass) work.masses.point.col(mass++) = X * part.X.p;
    const Pose X_after = X * part_pose(part, state, stage);
    if (part.column >= 0) place_columns(series, part, state, stage, X, X_after, work);
    X = X_after;
  }
  work.end = X;
  for (int c = 0; c < series.columns; ++c) {  // v = w x (p_E - o)
    if (series.turns(c)) work.v.col(c) = work.w.col(c).cross(X.p - work.point.col(c));
    if (series.screws[c]) work.v.col(c) += work.along.col(c);
  }
}

// Energy: its gradient, and its second derivatives into A.
void add_energy(const Part& part, const SeriesState& state, const Stage& stage, SeriesWork& work) {
  const int c = part.column;
  if (part.kind == PartKind::passive || part.kind == PartKind::compliance) {
    const JointForce<double> joint = force_of_joint(part, state, stage);
    work.gradient[c] += joint.force;
    work.A(c, c) += joint.stiffness;
  } else if (part.kind == PartKind::spring) {
    work.gradient.segment<6>(c).noalias() += part.K * spring_deflection(part, state, stage);
    work.A.block<6, 6>(c, c) += part.K;
  }
}

// Three rotations about one point: the coordinates of a rotation vector, or (D = 0) the twist of a group.
//     H_jk = dw_j/dx_k . M + f . (w_j x v_k),    M = (p_E - o) x f + m + sum m (p_m - o) x g
void set_triple(const Part& part, const SeriesState& state, const Vector6& F, const Vector3& weights_moment,
                SeriesWork& work) {
  const int c = part.column + 3;
  const Vector3 r = work.end.p - work.point.col(c), f = F.head<3>();
  const Vector3 M = r.cross(f) + F.tail<3>() + weights_moment;
  Matrix3 H = work.S.block<3, 3>(c, c).transpose();
  if (part.kind == PartKind::spring) {
    const auto D = left_jacobian_derivatives(state.x.segment<3>(c));
    const Vector3 M_before =
        work.v.middleCols<3>(part.column).transpose() * M;  // axes of the frame before the spring
    for (int k = 0; k < 3; ++k) H.col(k) += D[k].transpose() * M_before;
  }
  work.A.block<3, 3>(c, c) -= H;
}

// H = d(J'F)/dx with F held. For columns k upstream of j, S_jk = v_j . (f x w_k):
//     H_jk = S_jk + w_j . (m x w_k),    H_kj = S_jk
// The weights enter S alone: they are forces without a moment at points of their own.
void subtract_hessian(const Series& series, const SeriesState& state, const Vector3& g, SeriesWork& work) {
  const Vector3 f = state.F.head<3>(), m = state.F.tail<3>();
  for (int k = 0; k < series.columns; ++k) work.f_x_w.col(k) = f.cross(work.w.col(k));
  work.S.noalias() = work.v.transpose().lazyProduct(work.f_x_w);
  if (work.weight > 0) add_second_moments(g, work);
  for (int k = 0; k < series.columns; ++k) {
    const Vector3 m_x_w = m.cross(work.w.col(k));
    work.A(k, k) -= work.S(k, k);
    for (int j = k + 1; j < series.columns; ++j) {
      work.A(j, k) -= work.S(j, k) + work.w.col(j).dot(m_x_w);
      work.A(k, j) -= work.S(j, k);
    }
  }
}

// The general formula was wrong inside a triple: its block is computed again.
void mend_triples(const Series& series, const SeriesState& state, const Vector3& g, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::spring && part.kind != PartKind::group) continue;
    const int c = part.column + 3;
    if (part.kind == PartKind::spring)
      work.A.block<3, 3>(c, c) = part.K.bottomRightCorner<3, 3>();
    else
      work.A.block<3, 3>(c, c).setZero();
    const Vector3 weights_moment =
        work.weight > 0 ? Vector3(work.masses.arm.col(c).cross(g)) : Vector3::Zero();
    set_triple(part, state, state.F, weights_moment, work);
  }
}

void evaluate_branches(const Series& series, const SeriesState& state, const Stage& stage, const Vector3& g,
                       Hessians hessians, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const GroupState& group = state.groups[part.group];
    const Vector3 g_group =
        work.v.middleCols<3>(part.column).transpose() * g;  // axes of the frame where branches start
    for (std::size_t b = 0; b < group.branches.size(); ++b) {
      evaluate(series.groups[part.group].branches[b], group.branches[b], group.X, stage, g_group, hessians,
               work.groups[part.group][b]);
      work.gradient.segment<6>(part.column) += group.branches[b].F;
    }
  }
}

}  // namespace

SeriesWork make_work(const Series& series) {
  SeriesWork work;
  const int n = series.columns, size = 6 + static_cast<int>(series.free.size());
  const int sides = 7 + (series.leans ? 3 : 0);
  work.v.setZero(3, n);
  work.w.setZero(3, n);
  work.point.setZero(3, n);
  work.along.setZero(3, n);
  work.f_x_w.setZero(3, n);
  work.S.setZero(n, n);
  work.A.setZero(n, n);
  work.gradient.setZero(n);
  work.bordered.setZero(size, size);
  work.rhs.setZero(size, sides);
  work.solution.setZero(size, sides);
  work.lu = Eigen::PartialPivLU<Eigen::MatrixXd>(size);
  make_mass_work(series, work);
  for (const SeriesGroup& group : series.groups) {
    work.groups.emplace_back();
    for (const Series& branch : group.branches) work.groups.back().push_back(make_work(branch));
  }
  return work;
}

void evaluate(const Series& series, const SeriesState& state, const Pose& X_end, const Stage& stage,
              const Vector3& g, Hessians hessians, SeriesWork& work) {
  place(series, state, stage, work);
  work.gap = difference(X_end, work.end);
  work.weight = series.mass * g.norm();
  work.gradient.setZero();
  work.A.setZero();
  evaluate_branches(series, state, stage, g, hessians, work);
  if (work.weight > 0) carry_masses(series, state, work);
  if (hessians == Hessians::yes) subtract_hessian(series, state, g, work);
  for (const Part& part : series.parts) add_energy(part, state, stage, work);
  if (hessians == Hessians::yes) mend_triples(series, state, g, work);
  if (series.leans) lean(g, hessians, work);
  if (work.weight > 0) work.gradient.noalias() -= work.masses.V.transpose() * g;
  work.gradient.noalias() -= work.v.transpose() * state.F.head<3>();
  work.gradient.noalias() -= work.w.transpose() * state.F.tail<3>();
}

void add_residual(const Series& series, const SeriesState& state, const SeriesWork& work, const Units& units,
                  Residual& residual) {
  residual.closure = std::max(residual.closure, twist_size(work.gap, units));
  for (int c : series.free)
    residual.force =
        std::max(residual.force, std::abs(work.gradient[c]) / (series.angular[c] ? units.length : 1.0));
  residual.largest = std::max({residual.largest, wrench_size(state.F, units), work.weight});
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      add_residual(series.groups[g].branches[b], state.groups[g].branches[b], work.groups[g][b], units,
                   residual);
}

}  // namespace counterflex
