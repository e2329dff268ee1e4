#include "statics/theory/whole_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/spectrum.hpp"
#include "statics/model/part.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/model/walk.hpp"

namespace counterflex {
namespace {

// A column before the point that the walk has reached, and the rotation that it causes there (axes of that
// frame).
struct Turning {
  int variable;
  Vector3 w;
};

// A series in the system: where its variables and closures begin.
struct ListedSeries {
  const Series& series;
  const SeriesWork& work;
  int variable, closure;
  int parent = -1;              // of a branch: its number in the list
  const Part* group = nullptr;  // and its group there
};

// All series in one fixed order, branches behind what they are part of; then the platform's variables.
struct SeriesList {
  std::vector<ListedSeries> all;
  int pose = 0;

  SeriesList(const Mechanism& mechanism, const std::vector<SeriesWork>& works) {
    for (std::size_t i = 0; i < works.size(); ++i) add(mechanism.chains[i], works[i], -1, nullptr);
  }

  void add(const Series& series, const SeriesWork& work, int parent, const Part* group) {
    const int own = static_cast<int>(all.size());
    all.push_back({series, work, pose, 6 * own, parent, group});
    pose += series.columns;
    for (const Part& part : series.parts) {
      if (part.kind != PartKind::group) continue;
      for (std::size_t b = 0; b < series.groups[part.group].branches.size(); ++b)
        add(series.groups[part.group].branches[b], work.groups[part.group][b], own, &part);
    }
  }

  // First variable of the frame at the end of a series.
  int end_of(const ListedSeries& at) const {
    return at.group == nullptr ? pose : all[at.parent].variable + at.group->column;
  }
};

void describe(const ListedSeries& at, std::vector<Variable>& variables) {
  for (const Part& part : at.series.parts) {
    const bool elastic = part.kind == PartKind::spring || part.kind == PartKind::compliance;
    for (int k = 0; k < columns_of(part); ++k)
      variables[at.variable + part.column + k] = {at.series.angular[part.column + k], elastic, part.actuator};
  }
}

Closures closures_of(const SeriesList& list, const Units& units) {
  Closures closures;
  closures.pose = list.pose;
  closures.variables.resize(list.pose + 6);
  const auto rows = 6 * static_cast<Eigen::Index>(list.all.size());
  closures.C.setZero(rows, list.pose + 6);
  closures.gap.resize(rows);
  const Vector6 pose = units.of_pose();
  for (const ListedSeries& at : list.all) {
    describe(at, closures.variables);
    for (int j = 0; j < at.series.columns; ++j) {
      Vector6 column;
      column << at.work.v.col(j), at.work.w.col(j);
      closures.C.block<6, 1>(at.closure, at.variable + j) =
          units.of_column(at.series.angular[j]) * column.cwiseQuotient(pose);
    }
    closures.C.block<6, 6>(at.closure, list.end_of(at)) = -Matrix6::Identity();
    closures.gap.segment<6>(at.closure) = at.work.gap.cwiseQuotient(pose);
  }
  for (int k = 3; k < 6; ++k) closures.variables[list.pose + k].angular = true;
  return closures;
}

// What turns the start frame of a branch, `outside` being what turns that of its parent.
std::vector<Turning> turnings_before(const ListedSeries& parent, const Part& group,
                                     const std::vector<Turning>& outside) {
  if (parent.series.mass == 0) return {};
  const Matrix3 R = parent.work.v.middleCols<3>(group.column);
  std::vector<Turning> list;
  for (const Turning& turning : outside) list.push_back({turning.variable, R.transpose() * turning.w});
  for (int k = 0; k < group.column; ++k)
    if (parent.series.turns(k)) list.push_back({parent.variable + k, R.transpose() * parent.work.w.col(k)});
  return list;
}

// The energy of a series: A and gradient.
void add_energy(const ListedSeries& at, const std::vector<Turning>& outside, const Units& units,
                WholeSystem& system) {
  const auto unit = [&](int column) { return units.of_column(at.series.angular[column]); };
  const int v0 = at.variable;
  for (int j = 0; j < at.series.columns; ++j) {
    system.gradient[v0 + j] = unit(j) / units.energy() * at.work.gradient[j];
    for (int i = 0; i < at.series.columns; ++i)
      system.A(v0 + i, v0 + j) = unit(j) * unit(i) / units.energy() * at.work.A(i, j);
  }
  if (!at.series.leans) return;
  // Weights inside a branch couple its columns to everything that turns its start frame.
  for (const Turning& turning : outside)
    for (int j = 0; j < at.work.lean.A_w.rows(); ++j) {
      const double entry = unit(j) / units.energy() * at.work.lean.A_w.row(j).dot(turning.w);
      system.A(v0 + j, turning.variable) = entry;
      system.A(turning.variable, v0 + j) = entry;
    }
}

// Columns of the variables that equilibrium determines: all, or all but the actuators.
std::vector<int> unknowns(const WholeSystem& system, bool with_actuators) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.variables.size()); ++i)
    if (with_actuators || system.variables[i].actuator < 0) list.push_back(i);
  return list;
}

// The bordered matrix over unknown variables and closures; stationarity rows only of what is not an actuator.
Eigen::MatrixXd bordered(const WholeSystem& system, const std::vector<int>& columns,
                         const std::vector<int>& rows) {
  const auto n = static_cast<int>(columns.size()), m = static_cast<int>(rows.size());
  const auto closures = static_cast<int>(system.C.rows());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(m + closures, n + closures);
  B.topLeftCorner(m, n) = system.A(rows, columns);
  B.topRightCorner(m, closures) = -system.C(Eigen::all, rows).transpose();
  B.bottomLeftCorner(closures, n) = system.C(Eigen::all, columns);
  return B;
}

// Divides rows and columns of variables that are stiffer than `stiff_enough` until they are as stiff as that.
void soften(const WholeSystem& system, const std::vector<int>& columns, Eigen::MatrixXd& B) {
  constexpr double limit = stiff_enough / Units::stiffness;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double stiffness = std::abs(system.A(columns[i], columns[i]));
    if (stiffness <= limit) continue;
    const auto at = static_cast<Eigen::Index>(i);
    B.row(at) *= std::sqrt(limit / stiffness);
    B.col(at) *= std::sqrt(limit / stiffness);
  }
}

// What may be missing to the least eigenvalue: rounding of the matrices, and forces that are out of balance.
double eigenvalue_error(const WholeSystem& system) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  return rounding * static_cast<double>(system.variables.size()) + 4 * system.force_error / system.wrench;
}

}  // namespace

Closures assemble_closures(const Mechanism& mechanism, const std::vector<SeriesWork>& works,
                           const Units& units) {
  return closures_of({mechanism, works}, units);
}

WholeSystem assemble_whole(const Mechanism& mechanism, const std::vector<SeriesWork>& works,
                           const PlatformTerms& platform, const Units& units) {
  const SeriesList list(mechanism, works);
  WholeSystem system{closures_of(list, units)};
  system.A.setZero(list.pose + 6, list.pose + 6);
  system.gradient.setZero(list.pose + 6);
  std::vector<std::vector<Turning>> outside(list.all.size());
  for (std::size_t i = 0; i < list.all.size(); ++i) {
    const ListedSeries& at = list.all[i];
    if (at.group != nullptr) outside[i] = turnings_before(list.all[at.parent], *at.group, outside[at.parent]);
    add_energy(at, outside[i], units, system);
  }
  const Vector6 pose = units.of_pose();
  system.gradient.tail<6>() = platform.gradient.cwiseProduct(pose) / units.energy();
  system.A.bottomRightCorner<6, 6>() = pose.asDiagonal() * platform.A * pose.asDiagonal() / units.energy();
  return system;
}

WholeStep solve_whole(const WholeSystem& system, const std::optional<Controlled>& controlled,
                      const Units& units) {
  const auto columns = unknowns(system, controlled && !controlled->by_forces), rows = unknowns(system, false);
  const auto closures = system.C.rows(), pose = static_cast<Eigen::Index>(columns.size()) - 6;
  Eigen::MatrixXd B = bordered(system, columns, rows);
  Eigen::VectorXd rhs(B.rows());
  rhs << -system.gradient(rows), system.gap;
  if (controlled) {
    const auto n = controlled->rows.rows(), forces = controlled->by_forces ? n : 0, size = B.rows(),
               width = B.cols();
    B.conservativeResize(size + n, width + forces);
    B.bottomRows(n).setZero();
    B.rightCols(forces).setZero();
    B.block(size, pose, n, 6) = controlled->rows;
    if (forces > 0) B.block(pose, width, 6, n) = -controlled->rows.transpose();
    rhs.conservativeResize(size + n);
    rhs.tail(n) = controlled->rhs;
  }
  const Decomposition decomposition = decomposed(B);
  const Eigen::VectorXd x = solved(decomposition, rhs);
  WholeStep step;
  step.redundant = decomposition.rank() < B.cols();
  step.variables.setZero(static_cast<Eigen::Index>(system.variables.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    step.variables[columns[i]] = x[i] * units.of_column(system.variables[columns[i]].angular);
  step.wrenches = x.segment(pose + 6, closures);
  for (Eigen::Index c = 0; c < closures; ++c) step.wrenches[c] *= units.energy() / units.of_pose()[c % 6];
  step.forces = x.tail(x.size() - pose - 6 - closures) * units.energy() / units.length;
  return step;
}

Eigen::MatrixXd solve_held(const WholeSystem& system, const HeldSteps& given, const Units& units) {
  std::vector<int> columns;
  for (const int i : unknowns(system, false))
    if (!given.is_held[static_cast<std::size_t>(i)]) columns.push_back(i);
  Eigen::MatrixXd held = given.held;  // without unit
  for (Eigen::Index i = 0; i < held.rows(); ++i) held.row(i) /= units.of_column(system.variables[i].angular);
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd rhs(n + system.C.rows(), held.cols());
  rhs << -(system.A(columns, Eigen::all) * held + given.gradient(columns, Eigen::all)), -(system.C * held);
  const Eigen::MatrixXd x = solved(decomposed(bordered(system, columns, columns)), rhs);
  Eigen::MatrixXd steps = given.held;
  for (Eigen::Index i = 0; i < n; ++i)
    steps.row(columns[i]) = x.row(i) * units.of_column(system.variables[columns[i]].angular);
  return steps;
}

double apply(const Mechanism& mechanism, const WholeStep& step, const Units& units,
             Configuration& configuration) {
  int variable = 0, closure = 0;
  double largest = 0;
  for_each_series(mechanism.chains, configuration.chains, [&](const Series& series, SeriesState& state) {
    const auto own = step.variables.segment(variable, series.columns);
    for (int j = 0; j < series.columns; ++j)
      largest = std::max(largest, std::abs(own[j]) * (series.angular[j] ? units.length : 1.0));
    for (const Part& part : series.parts) {
      if (part.column < 0) continue;
      if (part.kind != PartKind::group) {
        state.x.segment(part.column, columns_of(part)) += own.segment(part.column, columns_of(part));
        continue;
      }
      Pose& X = state.groups[part.group].X;
      X = moved(X, own.segment<6>(part.column));
    }
    state.F += step.wrenches.segment<6>(closure);
    variable += series.columns;
    closure += 6;
  });
  const Vector6 pose_step = step.variables.tail<6>();
  configuration.X_MP = moved(configuration.X_MP, pose_step);
  return std::max(largest, twist_size(pose_step, units));
}

Condition condition(const WholeSystem& system, const Units& units) {
  const auto columns = unknowns(system, false);
  Eigen::MatrixXd B = bordered(system, columns, columns);
  soften(system, columns, B);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(B, Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  const auto n = sigma.size(), pose = static_cast<Eigen::Index>(columns.size()) - 6;
  Eigen::Index rank = n;
  while (rank > 1 && sigma[rank - 1] <= rank_threshold * sigma[0]) --rank;
  Condition result;
  const auto twist = [&](Eigen::Index i) { return Vector6(svd.matrixV().block<6, 1>(pose, i)); };
  result.weakest = twist(rank - 1);
  result.value = sigma[0] / sigma[rank - 1];
  for (Eigen::Index i = rank; i < n; ++i) {
    if (svd.matrixV().col(i).tail(system.C.rows()).norm() > moves_platform) result.indeterminate = true;
    if (twist(i).norm() <= moves_platform) continue;
    result.value = std::numeric_limits<double>::infinity();
    result.weakest = twist(i);
  }
  result.weakest = result.weakest.cwiseProduct(units.of_pose());
  return result;
}

bool determines_end(const WholeSystem& system) {
  auto columns = unknowns(system, false);
  columns.resize(columns.size() - 6);  // the platform is held
  Eigen::MatrixXd B = bordered(system, columns, columns);
  soften(system, columns, B);
  return null_space(B).middleRows<6>(static_cast<Eigen::Index>(columns.size())).norm() <= moves_platform;
}

double condition_bound(const WholeSystem& system) {
  const auto columns = unknowns(system, false);
  Eigen::MatrixXd B = bordered(system, columns, columns);
  soften(system, columns, B);
  const double bound = B.norm() * Eigen::PartialPivLU<Eigen::MatrixXd>(B).inverse().norm();
  return std::isfinite(bound) ? bound : std::numeric_limits<double>::infinity();
}

double least_scaled_eigenvalue(const WholeSystem& system) {
  const auto columns = unknowns(system, false);
  Eigen::MatrixXd C = system.C(Eigen::all, columns), A = system.A(columns, columns);
  const Eigen::VectorXd scale = A.diagonal().cwiseAbs().cwiseMax(system.wrench).cwiseSqrt().cwiseInverse();
  C = C * scale.asDiagonal();
  A = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::MatrixXd Z = null_space(C);
  if (Z.cols() == 0) return 0;
  const Eigen::MatrixXd symmetric = 0.5 * (A + A.transpose()), Z_A = Z.transpose() * symmetric;
  const double least = eigenvalues(Z_A * Z)[0];
  return least < 0 && least > -eigenvalue_error(system) ? 0 : least;
}

}  // namespace counterflex
