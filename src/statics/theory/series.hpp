#pragma once
/// One series at one state: its Jacobian, Hessian and residuals, and its condensation to the end's wrench.
/// The same code serves a chain between base and platform and a branch between the two frames of a group.
/// EQUATIONS.md, sections 2-4.
#include "counterflex/statics/mechanism.hpp"
#include "statics/model/units.hpp"
#include "statics/theory/decompositions.hpp"

namespace counterflex {

using Matrix63 = Eigen::Matrix<double, 6, 3>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Where the masses of a series are, and how they move with its columns (start axes).
struct MassWork {
  Eigen::Matrix<double, 3, Eigen::Dynamic> point;  ///< of its own masses
  Vector3 moment;                                  ///< sum of m p, branches' masses included
  Eigen::Matrix<double, 3, Eigen::Dynamic> arm;    ///< by column: sum of m (p - o) over the masses after it
  Eigen::Matrix<double, 3, Eigen::Dynamic> V;  ///< by column: sum of m v, v the velocity of a mass after it
  Eigen::Matrix<double, 3, Eigen::Dynamic> g_x_w;
};

/// What a turn w of its start frame (start axes) does to a branch that leans, and the torque N that its
/// weights exert on that frame. EQUATIONS.md, section 10.
struct LeanWork {
  Eigen::Matrix<double, Eigen::Dynamic, 3> A_w;  ///< d gradient / dw
  Eigen::Matrix<double, 3, Eigen::Dynamic> N_x;  ///< dN/dx
  Matrix63 G_w;                                  ///< of condense(): F_new = F + dF + K dxi + G_w dw
  Eigen::Matrix<double, 3, Eigen::Dynamic> N;    ///< of condense(): change of N by the columns of `solution`
};

/// What pulls at masses at a stage (m/s2, axes of M).
inline Vector3 acting_gravity(const Mechanism& mechanism, const Stage& stage) {
  return stage.gravity * mechanism.gravity;
}

struct SeriesWork {
  Pose end;  ///< of the end frame in the start frame
  Eigen::Matrix<double, 3, Eigen::Dynamic> v,
      w;  ///< twist of the end per column: translation, rotation (start axes)
  Eigen::Matrix<double, 3, Eigen::Dynamic> point;  ///< where a column's axis passes
  Eigen::Matrix<double, 3, Eigen::Dynamic> along;  ///< of a screw: velocity of that point
  Eigen::Matrix<double, 3, Eigen::Dynamic> f_x_w;
  Eigen::MatrixXd S;
  Eigen::MatrixXd A;         ///< K - H over all columns; a group's own stiffness is not in it
  Eigen::VectorXd gradient;  ///< dE/dx - J'F by column; a group's rows: wrench of its branches - J'F
  Vector6 gap;               ///< closure: end wanted minus end reached
  double weight = 0;         ///< N, of all its masses
  MassWork masses;
  LeanWork lean;

  Eigen::MatrixXd bordered, rhs, solution;  ///< of condense(), in units of `Units`
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Vector6 dF;  ///< F_new = F + dF + K dxi
  Matrix6 K;
  std::vector<std::vector<SeriesWork>> groups;
};

SeriesWork make_work(const Series& series);

/// Whether the second derivatives of (3)-(5) are used; the paper's (2) goes without.
enum class Hessians { no, yes };

/// Fills frames, Jacobian, A, gradient and gap of a series whose end should be at `X_end`. `g` is the gravity
/// that acts (m/s2, start axes).
void evaluate(const Series& series, const SeriesState& state, const Pose& X_end, const Stage& stage,
              const Vector3& g, Hessians hessians, SeriesWork& work);

/// Eliminates everything inside the series: fills dF and K. False where the bordered matrix is singular:
/// then only the whole system can decide.
bool condense(const Series& series, const Units& units, SeriesWork& work);

/// Series in parallel, whose ends move together: F_new = F + dF + K dxi of the sum of their wrenches.
///
///     K = sum K_i                                                             (7), (18)
struct Aggregate {
  Matrix6 K = Matrix6::Zero();
  Vector6 dF = Vector6::Zero();
};

/// Condenses and sums evaluated series; empty where one of them cannot be condensed.
std::optional<Aggregate> aggregate(const std::vector<Series>& all, const Units& units,
                                   std::vector<SeriesWork>& works);

/// Adds to the state the step that belongs to a step `dxi` of the end and to a turn `dw` of its start frame
/// (start axes), actuators held; returns the largest of its entries (m, rad times l).
double take_step(const Series& series, const Vector6& dxi, const Vector3& dw, const Units& units,
                 const SeriesWork& work, SeriesState& state);

/// The largest residuals of a series and its branches.
struct Residual {
  double closure = 0;  ///< m, rad times l
  double force = 0;    ///< N, N m divided by l
  double largest = 0;  ///< wrench that a series carries, same units
};
void add_residual(const Series& series, const SeriesState& state, const SeriesWork& work, const Units& units,
                  Residual& residual);

// The weights of a series' masses: how they move with its columns, and how a branch feels that its start
// frame turns. EQUATIONS.md, section 10.

/// Room for the masses of `series`.
void make_mass_work(const Series& series, SeriesWork& work);

/// Fills `work.masses` from placed columns and evaluated branches; g_x_w apart.
void carry_masses(const Series& series, const SeriesState& state, SeriesWork& work);

/// Adds the weights to S: V_j . (g x w_k) for columns k upstream of j.
void add_second_moments(const Vector3& g, SeriesWork& work);

/// Begins the lean of a branch: how its own gradient turns with its start frame. Zero without Hessians.
void lean(const Vector3& g, Hessians hessians, SeriesWork& work);

/// Adds what the turning of a group's start frame does to a condensed branch that leans, and what the
/// branch's weights do to that frame, to the rows and columns of the series before the group (and to its own
/// lean, if it has one).
void enter_lean(const Series& series, const Part& group, const SeriesWork& branch, SeriesWork& work);

}  // namespace counterflex
