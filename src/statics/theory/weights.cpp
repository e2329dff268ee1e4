#include <Eigen/Geometry>

#include "statics/model/part.hpp"
#include "statics/theory/series.hpp"

namespace counterflex {
namespace {

// Masses met so far on the way from the end of a series to its start.
struct MassesAfter {
  double mass = 0;
  Vector3 moment = Vector3::Zero();

  void add(double m, const Vector3& m_p) {
    mass += m;
    moment += m_p;
  }
};

// v of a mass is w x (p - o), or the axis along which a column moves it; of a screw their sum.
void carry_column(const Series& series, int c, const MassesAfter& after, SeriesWork& work) {
  MassWork& masses = work.masses;
  if (!series.turns(c)) {
    masses.V.col(c) = after.mass * work.v.col(c);
    return;
  }
  masses.arm.col(c) = after.moment - after.mass * work.point.col(c);
  masses.V.col(c) = work.w.col(c).cross(masses.arm.col(c));
  if (series.screws[c]) masses.V.col(c) += after.mass * work.along.col(c);
}

// A group's end does not carry the masses of its branches; what carries its start does.
void add_branches(const Series& series, const SeriesState& state, const Part& group, const SeriesWork& work,
                  MassesAfter& after) {
  const Matrix3 R = work.v.middleCols<3>(group.column);
  const Vector3 p = work.point.col(group.column + 3) - R * state.groups[group.group].X.p;
  const auto& branches = series.groups[group.group].branches;
  for (std::size_t b = 0; b < branches.size(); ++b)
    if (branches[b].mass > 0)
      after.add(branches[b].mass, branches[b].mass * p + R * work.groups[group.group][b].masses.moment);
}

}  // namespace

void make_mass_work(const Series& series, SeriesWork& work) {
  if (series.mass > 0) {
    work.masses.point.setZero(3, series.masses);
    work.masses.arm.setZero(3, series.columns);
    work.masses.V.setZero(3, series.columns);
    work.masses.g_x_w.setZero(3, series.columns);
  }
  if (!series.leans) return;
  work.lean.A_w.setZero(series.columns, 3);
  work.lean.N_x.setZero(3, series.columns);
  work.lean.G_w.setZero();
  work.lean.N.setZero(3, work.rhs.cols());
}

void carry_masses(const Series& series, const SeriesState& state, SeriesWork& work) {
  MassesAfter after;
  int mass = series.masses;
  for (auto part = series.parts.rbegin(); part != series.parts.rend(); ++part) {
    for (int c = part->column + columns_of(*part) - 1; c >= part->column && c >= 0; --c)
      carry_column(series, c, after, work);
    if (part->kind == PartKind::mass) after.add(part->mass, part->mass * work.masses.point.col(--mass));
    if (part->kind == PartKind::group) add_branches(series, state, *part, work, after);
  }
  work.masses.moment = after.moment;
}

void add_second_moments(const Vector3& g, SeriesWork& work) {
  MassWork& masses = work.masses;
  for (Eigen::Index k = 0; k < work.w.cols(); ++k) masses.g_x_w.col(k) = g.cross(work.w.col(k));
  work.S.noalias() += masses.V.transpose().lazyProduct(masses.g_x_w);
}

// The gradient is -V_c . g, and g turns against the frame: dg = g x w.
void lean(const Vector3& g, Hessians hessians, SeriesWork& work) {
  LeanWork& lean = work.lean;
  lean.N.setZero();
  if (hessians == Hessians::yes && work.weight > 0)
    for (Eigen::Index c = 0; c < work.masses.V.cols(); ++c) lean.N_x.col(c) = g.cross(work.masses.V.col(c));
  else
    lean.N_x.setZero();
  lean.A_w.noalias() = lean.N_x.transpose();
}

void enter_lean(const Series& series, const Part& group, const SeriesWork& branch, SeriesWork& work) {
  const int c = group.column, w = static_cast<int>(branch.lean.N.cols()) - 3;
  const Matrix3 R = work.v.middleCols<3>(c);
  const LeanWork& inner = branch.lean;
  const Vector3 N_0 = R * inner.N.col(0);
  const Matrix36 N_xi = R * inner.N.middleCols<6>(1);
  const Matrix3 N_w = R * inner.N.middleCols<3>(w) * R.transpose();
  const Matrix63 G_w = inner.G_w * R.transpose();
  for (int k = 0; k < c; ++k) {
    if (!series.turns(k)) continue;
    const Vector3 w_k = work.w.col(k), N_w_k = N_w.transpose() * w_k;
    work.gradient[k] += w_k.dot(N_0);
    work.A.block<1, 6>(k, c) += w_k.transpose() * N_xi;
    work.A.block<6, 1>(c, k) += G_w * w_k;
    for (int j = 0; j < c; ++j)
      if (series.turns(j)) work.A(k, j) += N_w_k.dot(work.w.col(j));
    if (!series.leans) continue;
    work.lean.A_w.row(k) += N_w_k.transpose();
    work.lean.N_x.col(k) += N_w * w_k;
  }
  if (!series.leans) return;
  work.lean.A_w.middleRows<6>(c) += G_w;
  work.lean.N_x.middleCols<6>(c) += N_xi;
  work.lean.N.col(0) += N_0;
  work.lean.N.rightCols<3>() += N_w;
}

}  // namespace counterflex
