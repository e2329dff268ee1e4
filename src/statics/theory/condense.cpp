#include <algorithm>

#include <Eigen/Geometry>

#include "statics/theory/weights.hpp"

namespace counterflex {
namespace {

constexpr double smallest_pivot_ratio = 1e-12;

// What a group's branches add to its six columns: stiffness, corrected wrench, and dependence on inner actuators.
struct GroupTerms {
  Matrix6 K = Matrix6::Zero();
  Vector6 dF = Vector6::Zero();
};

bool condense_branches(const Series& series, const Units& units, bool with_actuators, SeriesWork& work) {
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      if (!condense(series.groups[g].branches[b], units, with_actuators, work.groups[g][b])) return false;
  return true;
}

GroupTerms sum_branches(const std::vector<SeriesWork>& branches) {
  GroupTerms sum;
  for (const SeriesWork& branch : branches) {
    sum.K += branch.K;
    sum.dF += branch.dF;
  }
  return sum;
}

// Adds the group's terms to A and gradient: it enters as a spring with six coordinates.
void enter_groups(const Series& series, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const GroupTerms terms = sum_branches(work.groups[part.group]);
    work.A.block<6, 6>(part.column, part.column) += terms.K;
    work.gradient.segment<6>(part.column) += terms.dF;
    const auto& branches = series.groups[part.group].branches;
    for (std::size_t b = 0; b < branches.size(); ++b)
      if (branches[b].leans) enter_lean(series, part, work.groups[part.group][b], work);
  }
}

//     [ 0    J  ] [ dF ]   [ gap + dxi - J_rho drho ]
//     [ J'  -A  ] [ dx ] = [ gradient + A_rho drho  ]      in units of `Units`
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

int position_of(const Series& series, int actuator) {
  return static_cast<int>(std::lower_bound(series.actuators.begin(), series.actuators.end(), actuator) -
                          series.actuators.begin());
}

void assemble_own_actuators(const Series& series, const Units& units, SeriesWork& work) {
  const Vector6 pose = units.of_pose();
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::actuator) continue;
    auto column = work.rhs.col(7 + position_of(series, part.actuator));
    Vector6 J_rho;
    J_rho << work.v.col(part.column), work.w.col(part.column);
    column.head<6>() = -J_rho.cwiseQuotient(pose);
    for (std::size_t i = 0; i < series.free.size(); ++i) {
      const int c = series.free[i];
      column[6 + i] = units.of_column(series.angular[c]) / units.energy() * work.A(c, part.column);
    }
  }
}

// A branch's inner actuators move its weights, whose torque the columns before the group feel.
void assemble_inner_weights(const Series& series, const Part& group, const SeriesWork& branch, int side, Eigen::Index a,
                            const Units& units, SeriesWork& work) {
  const Vector3 N_a = work.v.middleCols<3>(group.column) * branch.lean.N.col(7 + a);
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    if (c < group.column && series.angular[c]) work.rhs(6 + i, side) += work.w.col(c).dot(N_a) / units.energy();
  }
  if (series.leans) work.lean.N.col(side) += N_a;
}

// Rows of a group depend on the actuators inside its branches.
void assemble_inner_actuators(const Series& series, const Units& units, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto first = std::find(series.free.begin(), series.free.end(), part.column) - series.free.begin();
    const auto& branches = series.groups[part.group].branches;
    for (std::size_t b = 0; b < branches.size(); ++b)
      for (std::size_t a = 0; a < branches[b].actuators.size(); ++a) {
        const SeriesWork& branch = work.groups[part.group][b];
        const int side = 7 + position_of(series, branches[b].actuators[a]);
        work.rhs.col(side).segment<6>(6 + first) += branch.G.col(a).cwiseProduct(units.of_pose()) / units.energy();
        if (branches[b].leans) assemble_inner_weights(series, part, branch, side, a, units, work);
      }
  }
}

void assemble_lean(const Series& series, const Units& units, SeriesWork& work) {
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    work.rhs.rightCols<3>().row(6 + i) = units.of_column(series.angular[c]) / units.energy() * work.lean.A_w.row(c);
  }
}

//     G_w and N: what the turn of the start does to F, and what all steps do to the weights' torque about the start
void finish_lean(const Series& series, const Units& units, bool with_actuators, SeriesWork& work) {
  LeanWork& lean = work.lean;
  lean.G_w = units.of_pose().cwiseInverse().asDiagonal() * work.solution.topRightCorner<6, 3>() * units.energy();
  for (std::size_t i = 0; i < series.free.size(); ++i) {
    const int c = series.free[i];
    const Vector3 N_x = units.of_column(series.angular[c]) * lean.N_x.col(c);
    for (Eigen::Index side = 0; side < work.solution.cols(); ++side) lean.N.col(side) += N_x * work.solution(6 + i, side);
  }
  if (!with_actuators) return;
  for (const Part& part : series.parts)
    if (part.kind == PartKind::actuator)
      lean.N.col(7 + position_of(series, part.actuator)) += lean.N_x.col(part.column);
}

bool factor(SeriesWork& work) {
  work.lu.compute(work.bordered);
  const auto pivots = work.lu.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > smallest_pivot_ratio * pivots.maxCoeff();
}

}  // namespace

bool condense(const Series& series, const Units& units, bool with_actuators, SeriesWork& work) {
  if (!condense_branches(series, units, with_actuators, work)) return false;
  enter_groups(series, work);
  assemble_bordered(series, units, work);
  if (!factor(work)) return false;
  assemble_constant_and_pose_columns(series, units, work);
  if (with_actuators) {
    assemble_own_actuators(series, units, work);
    assemble_inner_actuators(series, units, work);
  }
  if (series.leans) assemble_lean(series, units, work);
  work.solution = work.lu.solve(work.rhs);
  const Vector6 to_wrench = units.of_pose().cwiseInverse() * units.energy();
  work.dF = to_wrench.cwiseProduct(work.solution.block<6, 1>(0, 0));
  work.K = to_wrench.asDiagonal() * work.solution.block<6, 6>(0, 1);
  work.G = to_wrench.asDiagonal() * work.solution.block(0, 7, 6, work.G.cols());
  if (series.leans) finish_lean(series, units, with_actuators, work);
  return true;
}

double take_step(const Series& series, const Vector6& dxi, const Eigen::VectorXd& drho, const Vector3& dw,
                 const Units& units, const SeriesWork& work, SeriesState& state) {
  double largest = 0;
  Vector3 turn = dw;  // of the frame that the walk along the parts has reached
  const auto along = [&](int row) {
    double value = work.solution(row, 0) + work.solution.block<1, 6>(row, 1).dot(dxi);
    for (std::size_t a = 0; a < series.actuators.size(); ++a)
      value += work.solution(row, 7 + a) * drho[series.actuators[a]];
    if (series.leans) value += work.solution.rightCols<3>().row(row).dot(dw);
    return value;
  };
  const Vector6 to_wrench = units.of_pose().cwiseInverse() * units.energy();
  for (int i = 0; i < 6; ++i) state.F[i] += to_wrench[i] * along(i);
  std::size_t i = 0;
  for (const Part& part : series.parts) {
    if (part.column < 0) continue;
    if (part.kind == PartKind::actuator) {
      state.x[part.column] += drho[part.actuator];
      turn += work.w.col(part.column) * drho[part.actuator];
      continue;
    }
    const int size = part.kind == PartKind::spring || part.kind == PartKind::group ? 6 : 1;
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
      largest = std::max(largest, take_step(series.groups[part.group].branches[b], step, drho, dw_group, units,
                                            work.groups[part.group][b], group.branches[b]));
  }
  return largest;
}

}  // namespace counterflex
