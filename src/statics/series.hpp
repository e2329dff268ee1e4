#pragma once
/// One series at one state: its Jacobian, Hessian and residuals, and its condensation to the end's wrench. The same code
/// serves a chain between base and platform and a branch between the two frames of a group. EQUATIONS.md, sections 2-4.
#include "counterflex/statics/configuration.hpp"
#include "decompositions.hpp"

namespace counterflex {

/// Units in which matrices are compared and pivoted: lengths in l, forces in k l, moments in k l^2 with k = 1e6 N/m.
struct Units {
  double length = 1;
  double energy() const { return 1e6 * length * length; }
  double of_column(bool angular) const { return angular ? 1.0 : length; }
  /// Of the rows of a closure (m m m rad rad rad); a wrench times this, divided by energy(), is without unit.
  Vector6 of_pose() const { return (Vector6() << length, length, length, 1, 1, 1).finished(); }
};

struct SeriesWork {
  Pose end;                                      ///< of the end frame in the start frame
  Eigen::Matrix<double, 3, Eigen::Dynamic> v, w;  ///< twist of the end per column: translation, rotation (start axes)
  Eigen::Matrix<double, 3, Eigen::Dynamic> point; ///< where a column's axis passes
  Eigen::Matrix<double, 3, Eigen::Dynamic> f_x_w;
  Eigen::MatrixXd S;
  Eigen::MatrixXd A;         ///< K - H over all columns; a group's own stiffness is not in it
  Eigen::VectorXd gradient;  ///< dE/dx - J'F by column; a group's rows: wrench of its branches - J'F
  Vector6 gap;               ///< closure: end wanted minus end reached

  Eigen::MatrixXd bordered, rhs, solution;       ///< of condense(), in units of `Units`
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Vector6 dF;                                    ///< F_new = F + dF + K dxi + G drho
  Matrix6 K;
  Eigen::Matrix<double, 6, Eigen::Dynamic> G;    ///< by Series::actuators
  std::vector<std::vector<SeriesWork>> groups;
};

SeriesWork make_work(const Series& series);

/// Whether the second derivatives of (3)-(5) are used; the paper's (2) goes without.
enum class Hessians { no, yes };

/// Fills frames, Jacobian, A, gradient and gap of a series whose end should be at `X_end`.
void evaluate(const Series& series, const SeriesState& state, const Pose& X_end, const Stage& stage, Hessians hessians,
              SeriesWork& work);

/// Eliminates everything inside the series: fills dF, K and, if asked, G. False where the bordered matrix is singular:
/// then only the whole system can decide.
bool condense(const Series& series, const Units& units, bool with_actuators, SeriesWork& work);

/// Adds to the state the step that belongs to a step `dxi` of the end (start axes) and `drho` of all actuators of the
/// machine; returns the largest of its entries (m, rad times l).
double take_step(const Series& series, const Vector6& dxi, const Eigen::VectorXd& drho, const Units& units,
                 const SeriesWork& work, SeriesState& state);

/// The largest residuals of a series and its branches.
struct Residual {
  double closure = 0;  ///< m, rad times l
  double force = 0;    ///< N, N m divided by l
  double largest = 0;  ///< wrench that a series carries, same units
};
void add_residual(const Series& series, const SeriesState& state, const SeriesWork& work, const Units& units,
                  Residual& residual);

/// Largest of |force| and |moment| / l.
double wrench_size(const Vector6& F, const Units& units);

}  // namespace counterflex
