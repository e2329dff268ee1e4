#pragma once
/// Waypoints solved by the kernel, many at once. Each answer depends on the model and its own request alone:
/// not on other requests, their order, the thread or the number of lanes. EQUATIONS.md, section 11.
#include <concepts>
#include <memory>
#include <span>

#include "counterflex/statics/directions.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// A position (M, m), and the rotation vector of an orientation against home's (rad, axes of M). Machines
/// that control no orientation ignore the second one.
struct TurnedPlace {
  Vector3 p, turn;

  template <std::convertible_to<Vector3> Position>
  TurnedPlace(const Position& at, const Vector3& turned = Vector3::Zero()) : p(at), turn(turned) {}
};

/// A place of the tip, the wrench there (N, N m; axes of M), and how actuators come to it.
struct BatchRequest {
  TurnedPlace at;
  Vector6 F = Vector6::Zero();
  Directions directions{};
  /// Forward: the actuators of the command (m, rad), where they are known, which saves nominal kinematics.
  /// All requests of a call have them, or none.
  const Eigen::VectorXd* rho = nullptr;
};

/// Forward: where the tip is when the place is commanded. Target: what has to be commanded for the tip to be
/// at its position; orientations that the machine controls are commanded. Pose: the same for the tip to have
/// its orientation, too.
enum class BatchQuestion { forward, target, pose };

/// If `solved` is true, `solve_forward` and `solve_target` would converge to the same equilibrium, and the
/// actuators are in their ranges. If it is false, ask them: the rest means nothing.
struct BatchAnswer {
  bool solved = false;
  Pose command;         ///< commanded pose of the nominal tip; its position where the question is forward
  Pose X_MT;            ///< of the real tip
  Eigen::VectorXd rho;  ///< forward: actuators of the command (m, rad), where they were not given
  int iterations = 0;   ///< Newton steps
};

/// The pose of the nominal tip at a position.
struct NominalAnswer {
  bool solved = false;
  Pose X_MT;
};

/// A short straight way, and the load along it: between `F0` and `F1` it changes evenly, but for the
/// differences `dF` that it has at some places.
struct BatchLine {
  Vector3 p0 = Vector3::Zero(), p1 = Vector3::Zero();  ///< M (m)
  Vector6 F0 = Vector6::Zero(), F1 = Vector6::Zero();  ///< at the ends (N, N m)
  std::span<const Vector6> dF{};
};

/// Bounds of what happens between the ends of a line. Infinite where they are not known: solve inside.
struct LineBend {
  double command;  ///< m: from the command to its chord, if the tip goes straight from p0 to p1
  /// m/m: of the tip for a change of the command; gain times command: from the tip to its chord, if the
  /// command goes straight.
  double gain;
};

class CellCache;

/// The cells of a model in which the kernel starts. Each is made when it is first needed, from its place
/// alone. Threads may share a table. The model must outlive it.
class StartTable {
 public:
  /// `at_platform`: where loads act, as in `Load`.
  StartTable(const Model& model, bool at_platform);
  /// The same with memory that other tables use, too.
  StartTable(const Model& model, bool at_platform, std::shared_ptr<CellCache> cells);
  ~StartTable();

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The tables of a run, one for each model and place of loads. The models must outlive it. Threads may share
/// it.
class StartTables {
 public:
  StartTables();
  ~StartTables();
  StartTables(StartTables&&) noexcept;

  const StartTable& of(const Model& model, bool at_platform) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Solves requests for one thread.
class BatchSolver {
 public:
  explicit BatchSolver(const StartTable& table);
  ~BatchSolver();
  BatchSolver(BatchSolver&&) noexcept;

  /// `answers` is as long as `requests`. `stage.load` is ignored: F acts. Not solved are machines that do not
  /// control x, y and z, and stages with a part of errors, weights or preloads.
  void solve(BatchQuestion question, const Stage& stage, std::span<const BatchRequest> requests,
             std::span<BatchAnswer> answers);

  /// `answers` is as long as `places`.
  void nominal_tips(std::span<const TurnedPlace> places, std::span<NominalAnswer> answers);

  /// The same for the nominal configurations there, whose rotary actuators are known but for full turns. What
  /// is not solved is not `converged`.
  void nominals(std::span<const TurnedPlace> places, std::span<NominalResult> answers);

  /// Bounds from the second-order expansions of the line's cell, or of two that share a face, and their
  /// measured remainders. EQUATIONS.md, section 11.
  LineBend bend_along(const BatchLine& line);

  /// The nominal configuration at the centre of the cell that holds the place; null if no cell can be made.
  /// It is valid until the next call.
  const Configuration* nominal_near(const TurnedPlace& place);

  /// Whether the straight way between two places near each other stays on one branch of the nominal
  /// kinematics. If it is false, follow the way: places are too far apart, or one of them has no cell.
  bool joins(const TurnedPlace& from, const TurnedPlace& to);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex
