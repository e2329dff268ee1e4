#pragma once
/// Measurements of a real machine: what was commanded, what acted, what a gauge or a tracker read.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/machine/machine.hpp"
#include "counterflex/statics/directions.hpp"

namespace counterflex {

enum class MeasurementKind {
  tracker_point,   ///< position of a target on the flange or the tool, in the tracker's frame
  tracker_pose,    ///< position and orientation of a probe, in the tracker's frame
  static_push,     ///< motion of the tip along a direction under a force
  hung_weight,     ///< the same under a mass that hangs at the tip
  plane_contact,   ///< the tip touches a plane
  length_bar,      ///< the tip is at one end of a bar, then at the other
  squareness,      ///< of two linear axes
  axis_position,   ///< tip along a direction, less the commanded one: the error of an axis at a position
  axis_table,      ///< motion of one axis, less the commanded one (ISO 230-2)
  reversal,        ///< lost motion of one axis at the tip
  scale,           ///< motion of a linear axis over the commanded one, less 1
  clamped_torque,  ///< turn of a rotary axis under a torque, the flange clamped
  ballbar,         ///< numbers of a ball bar's report; its rows become squareness, reversal and scale
  repeat,          ///< one of several readings at the same place; they show the noise of a session
  cmm_feature,     ///< position or size of a feature of a coupon, less the nominal one
};

/// How files and people name a kind: "tracker_point".
std::string_view name_of(MeasurementKind kind);

/// The standard deviation of rows that state none (m; rad or m/m of a value that is not a length).
double default_sigma(MeasurementKind kind);

/// The flange is clamped, and one actuator turns against its compliance.
struct ClampedTorque {
  std::size_t actuator = 0;
  double torque = 0;  ///< N m, in the direction of the shown value
};

/// The commanded actuator values, and the wrench on the tip.
struct CommandedState {
  Eigen::VectorXd shown;        ///< by actuator, as the control shows them (m, rad)
  Vector6 F = Vector6::Zero();  ///< on the tip, axes of M (N, N m)
  Directions directions{};      ///< in which the actuators moved last
  std::optional<ClampedTorque> clamped{};
  long tool = 0;  ///< in the spindle, of [tools]; 0: that of [tool]
};

/// What a feature of a coupon shows of the tip at one of its places.
struct FeaturePlace {
  Vector3 p_MT = Vector3::Zero();    ///< wanted tip, M (m), where the loaded part with its fixture has it
  Vector3 weight = Vector3::Zero();  ///< of the deviation there, axes of M
};

struct Measurement {
  std::size_t session = 0;  ///< index into `Measurements::sessions`
  Location at;              ///< of its row
  /// One; two of a push, a weight, a bar, a reversal (after a positive, a negative motion) or a scale; four
  /// of a squareness; as many as places of a feature.
  std::vector<CommandedState> states{};
  Pose X{};                             ///< tracker: measured, in the session's frame
  Vector3 direction = Vector3::Zero();  ///< of the gauge, or along or about the axis; unit vector in M
  Vector3 gauge = Vector3::Zero();  ///< of a push or weight: where the gauge touches, in the tip's frame (m)
  bool is_length = true;            ///< of value and sigma
  double value = 0;                 ///< m; else rad, or m/m of a scale
  double sigma = 0;                 ///< standard deviation of value
  double sigma_angle = 0;           ///< of an orientation (rad)
  std::vector<FeaturePlace> places{};  ///< of a feature, by state
  /// Of the session's unknown offset: of a feature, of the deviation of the tool's radius; of a push, of half
  /// the hysteresis.
  double offset_share = 0;
};

/// Rows that share their unknown frames: one set-up of a tracker, one plane.
struct Session {
  std::string name;
  MeasurementKind kind = MeasurementKind::tracker_point;
  bool sigma_given = false;  ///< else that of its rows is a default
  Pose X_TB{};               ///< probe B in the tip's frame, where it is expected
  /// Rows are in the machine frame, of the probe near X_TB; a plane is z = 0 of that frame.
  bool has_known_frame = false;
  double probe_sigma = 0.3;  ///< standard deviation of its position (m); 0: it is known
  /// Pushes: whether rows were read while the force grew, and while it fell. With both, half the difference
  /// that friction makes is unknown.
  bool has_loading = false, has_unloading = false;
  std::string file{};  ///< of its first row
};

/// One of several readings at the same place. No fit uses it.
struct RepeatedReading {
  std::string session;  ///< whose noise it shows
  std::string place;
  Location at;
  bool is_position = true;          ///< else a reading of a gauge
  Vector3 value = Vector3::Zero();  ///< m; of a gauge in the first component
};

struct Measurements {
  std::vector<Session> sessions;
  std::vector<Measurement> rows;
  std::vector<RepeatedReading> repeats{};
  std::size_t empty_rows = 0;  ///< of sheets, without a measured value
};

/// Reads a measurement file: CSV with the column names of the guide, a filled sheet of a coupon, or a TOML
/// file of the format "counterflex-measurements 1", which names a CSV file and defines its columns. Adds to
/// `all`. Throws `InputError` (ErrorKind::machine_or_force) with line and column.
void load_measurements(const std::string& file, const Machine& machine, Measurements& all);

/// The same from CSV text.
void read_measurements(std::string_view csv, const std::string& file, const Machine& machine,
                       Measurements& all);

}  // namespace counterflex
