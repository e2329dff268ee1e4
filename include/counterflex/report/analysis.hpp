#pragma once
/// A machine at single poses: deviation, stiffness, loads in joints and springs, and the corrected target. SI
/// inside; mm and degrees in the JSON and the text.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {

/// Whether the numbers beside a status mean something: travel is a limit of the machine, not of the solution.
inline bool has_values(Status status) {
  return status == Status::converged || status == Status::outside_travel;
}

/// The target that puts the loaded, imperfect machine's tip on the wanted pose.
struct CorrectedTarget {
  Pose X_MT;            ///< nominal forward kinematics of `rho`; `linear`: the linear target
  Eigen::VectorXd rho;  ///< actuator values (m, rad)
  /// Pose and actuators are meaningful only when `converged`, or `outside_travel`.
  Status status = Status::not_converged;
};

/// The tip held at a pose, the actuators commanded for the analyzed one: paper's (1).
struct HeldPose {
  Pose X_MT;
  Status status = Status::not_converged;
  std::string why;  ///< in words where `status` is not `converged`; what follows means something only then
  std::vector<ChainDetail> chains;
  Vector6 at_platform = Vector6::Zero();  ///< what holds it: N, N m at the reference point, axes of M
  Vector6 at_tip = Vector6::Zero();       ///< the same at the tip
};

/// What `analyze` computes besides the standard tables.
struct AnalysisExtras {
  /// Without the tool that the model has; null: the model has no tool of its own.
  const Mechanism* machine = nullptr;
  bool full = false;                  ///< details of every chain
  std::optional<Pose> hold;           ///< X_MT
  std::optional<CurveRequest> curve;  ///< its load is the analysis's own
};

struct PoseAnalysis {
  Pose X_MT;  ///< wanted tip: what is controlled as asked for, the rest by nominal kinematics
  Method method = Method::direct;
  /// Of the deviation; what follows is meaningful when `converged`, or `outside_travel` (of the nominal
  /// actuators).
  Status status = Status::not_converged;
  std::string why;  ///< in words where `status` is another
  /// Position (m), rotation vector of R_actual R_target' (rad), axes of M.
  Vector6 deviation = Vector6::Zero();
  /// SI, at the reference point; at the nominal pose for `linear`, else at the loaded one.
  Matrix6 K = Matrix6::Zero();
  std::optional<Matrix6> tip_compliance;     ///< `compliance_at_tip`, at the same pose
  std::optional<Matrix6> tip_stiffness;      ///< its inverse; none where the machine is rigid in a direction
  bool stiffness_available = false;          ///< every chain has a stiffness of its own
  Eigen::VectorXd rho;                       ///< nominal actuator values of the wanted pose (m, rad)
  std::optional<CorrectedTarget> corrected;  ///< none where the machine controls nothing
  std::vector<ChainLoads> chains;
  /// The twist of least stiffness (unit norm, lengths in units of l); zero: unknown.
  Vector6 weakest = Vector6::Zero();
  double weakest_stiffness = 0;       ///< in that direction (N/m); 0: not computed
  Vector3 softest = Vector3::Zero();  ///< direction (M) in which a force at the tip moves the tip furthest
  double softest_stiffness = 0;  ///< force over motion in that direction (N/m); 0: not computed, or rigid
  /// Redundant rigid closures: the chains' wrenches are the minimum-norm ones of many.
  bool indeterminate = false;
  double condition = 0;              ///< of the static system; 0: not computed
  double stability = 0;              ///< see `stability` in statics/equilibrium.hpp; 0: not computed
  std::vector<ChainDetail> details;  ///< of `AnalysisExtras::full`
  std::optional<HeldPose> held;
  std::optional<ForceCurve> curve;
  bool preloaded = false;  ///< springs of the nominal configuration are not relaxed
};

/// Why points of a force curve were not found, in words; empty where all were.
std::string reason(const ForceCurve& curve);

/// The pose `X_MT` of the tip (in the controlled components; all six where nothing is controlled) under
/// `load`. Loads of chains are those of `extras.machine`. Never throws: what could not be solved is a status.
PoseAnalysis analyze_pose(const Model& model, const Pose& X_MT, const Load& load, Method method,
                          const AnalysisExtras& extras = {});

struct AnalysisReport {
  std::string version;  ///< of the tool
  std::string machine;
  Load load;
  std::vector<Travel> travel;  ///< by actuator: its kind gives the unit, mm or deg
  ShownActuators shown;        ///< the texts have the shown values of actuators
  std::vector<PoseAnalysis> poses;
  std::string tool{};      ///< in the spindle, and its stiffness; empty: [tool]
  bool weighs = false;     ///< the machine's own weight acts, too
  bool preloaded = false;  ///< its preloads do, at one pose at least
  std::optional<CurveRequest> curve{};
};

/// Every pose of `poses` in order.
AnalysisReport analyze(const Model& model, const std::vector<Pose>& poses, const Load& load, Method method,
                       const std::string& version, const AnalysisExtras& extras = {});

/// "counterflex-analysis 1" (programs/guide/report.md), indented by two spaces, one newline at the end.
/// Values that were not computed are null.
std::string to_json(const AnalysisReport& report);

/// Tables for people: deviations of all poses, loads by chain, actuators, corrected targets, stiffness.
/// ASCII and at most 100 columns wide, but for names.
std::string to_text(const AnalysisReport& report);

/// How the table of force curves begins.
inline constexpr std::string_view curve_mark = "pose,displacement_mm,force_N";

/// The force curves of all poses: pose, displacement, force, tangent stiffness, stable, position of the tip.
std::string to_csv(const AnalysisReport& report);

}  // namespace counterflex
