#include <Eigen/Geometry>
#include <algorithm>

#include "statics/model/part.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/theory/series.hpp"

namespace counterflex {
namespace {

// Condenses the groups and adds their terms to A and gradient: a group enters as a spring with six
// coordinates.
bool enter_groups(const Series& series, const Units& units, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto& branches = series.groups[part.group].branches;
    const auto sum = aggregate(branches, units, work.groups[part.group]);
    if (!sum) return false;
    work.A.block<6, 6>(part.column, part.column) += sum->K;
    work.gradient.segment<6>(part.column) += sum->dF;
    for (std::size_t b = 0; b < branches.size(); ++b)
      if (branches[b].leans) enter_lean(series, part, work.groups[part.group][b], work);
  }
  return true;
}

//     [ 0    J  ] [ dF ]   [ gap + dxi ]
//     [ J'  -A  ] [ dx ] = [ gradient  ]      in units of `Units`
void assemble_bordered(const Series& series, const Units& units, SeriesWork& work) {
  const Vector6 pose = units.of_pose();
  const double energy = units.energy();
  const int n = static_cast<int>(series.free.size());
  work.bordered.topLeftCorner<6, 6>().setZero();
  for (int i = 0; i < n; ++i) {
    const int c = series.free[i];
    const double scale = units.of_column(series.angular[c]);
    Vector6 column;
    column << work.v.col(c), work.w.col(c);
    work.bordered.block<6, 1>(0, 6 + i) = scale * column.cwiseQuotient(pose);
    work.bordered.block<1, 6>(6 + i, 0) = work.bordered.block<6, 1>(0, 6 + i).transpose();
    for (int j = 0; j < n; ++j) {
      const int d = series.free[j];
      work.bordered(6 + i, 6 + j) = -scale * units.of_column(series.angular[d]) / energy * work.A(c, d);
    }
  }
}

void assemble_constant_and_pose_columns(const Series& series, const Units& units, SeriesWork& work) {
  const Vector6 pose = units.of_pose();
  work.rhs.setZero();
  work.rhs.block<6, 1>(0, 0) = work.gap.cwiseQuotient(pose);
  work.rhs.block<6, 6>(0, 1) = pose.cwiseInverse().asDiagonal();
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    work.rhs(6 + i, 0) = units.of_column(series.angular[c]) / units.energy() * work.gradient[c];
  }
}

void assemble_lean(const Series& series, const Units& units, SeriesWork& work) {
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    work.rhs.rightCols<3>().row(6 + i) =
        units.of_column(series.angular[c]) / units.energy() * work.lean.A_w.row(c);
  }
}

//     G_w and N: what the turn of the start does to F, and what all steps do to the weights' torque about the
//     start
void finish_lean(const Series& series, const Units& units, SeriesWork& work) {
  LeanWork& lean = work.lean;
  lean.G_w =
      units.of_pose().cwiseInverse().asDiagonal() * work.solution.topRightCorner<6, 3>() * units.energy();
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    const Vector3 N_x = units.of_column(series.angular[c]) * lean.N_x.col(c);
    for (Eigen::Index side = 0; side < work.solution.cols(); ++side)
      lean.N.col(side) += N_x * work.solution(6 + i, side);
  }
}

bool factor(SeriesWork& work) {
  work.lu.compute(work.bordered);
  const auto pivots = work.lu.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > rank_threshold * pivots.maxCoeff();
}

}  // namespace

bool condense(const Series& series, const Units& units, SeriesWork& work) {
  if (!enter_groups(series, units, work)) return false;
  assemble_bordered(series, units, work);
  if (!factor(work)) return false;
  assemble_constant_and_pose_columns(series, units, work);
  if (series.leans) assemble_lean(series, units, work);
  work.solution = work.lu.solve(work.rhs);
  const Vector6 to_wrench = units.of_pose().cwiseInverse() * units.energy();
  work.dF = to_wrench.cwiseProduct(work.solution.block<6, 1>(0, 0));
  work.K = to_wrench.asDiagonal() * work.solution.block<6, 6>(0, 1);
  if (series.leans) finish_lean(series, units, work);
  return true;
}

std::optional<Aggregate> aggregate(const std::vector<Series>& all, const Units& units,
                                   std::vector<SeriesWork>& works) {
  Aggregate sum;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!condense(all[i], units, works[i])) return std::nullopt;
    sum.K += works[i].K;
    sum.dF += works[i].dF;
  }
  return sum;
}

double take_step(const Series& series, const Vector6& dxi, const Vector3& dw, const Units& units,
                 const SeriesWork& work, SeriesState& state) {
  double largest = 0;
  Vector3 turn = dw;  // of the frame that the walk along the parts has reached
  const auto along = [&](int row) {
    double value = work.solution(row, 0) + work.solution.block<1, 6>(row, 1).dot(dxi);
    if (series.leans) value += work.solution.rightCols<3>().row(row).dot(dw);
    return value;
  };
  const Vector6 to_wrench = units.of_pose().cwiseInverse() * units.energy();
  for (int i = 0; i < 6; ++i) state.F[i] += to_wrench[i] * along(i);
  std::size_t i = 0;
  for (const Part& part : series.parts) {
    if (part.column < 0 || part.kind == PartKind::actuator) continue;
    const int size = columns_of(part);
    Vector6 step = Vector6::Zero();
    for (int k = 0; k < size; ++k, ++i) {
      step[k] = units.of_column(series.angular[series.free[i]]) * along(static_cast<int>(6 + i));
      largest = std::max(largest, std::abs(step[k]) * (series.angular[series.free[i]] ? units.length : 1.0));
    }
    const Vector3 turn_before = turn;
    for (int k = 0; k < size; ++k) turn += work.w.col(part.column + k) * step[k];
    if (part.kind != PartKind::group) {
      state.x.segment(part.column, size) += step.head(size);
      continue;
    }
    const Vector3 dw_group = work.v.middleCols<3>(part.column).transpose() * turn_before;
    GroupState& group = state.groups[part.group];
    group.X = moved(group.X, step);
    for (std::size_t b = 0; b < group.branches.size(); ++b)
      largest = std::max(largest, take_step(series.groups[part.group].branches[b], step, dw_group, units,
                                            work.groups[part.group][b], group.branches[b]));
  }
  return largest;
}

}  // namespace counterflex
