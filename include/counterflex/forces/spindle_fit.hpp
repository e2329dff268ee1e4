#pragma once
/// Cutting coefficients from a log of the spindle's power or torque.
///
/// The torque about the tool's axis is proportional to K_tc, the edge aside. A sample at a place of the
/// program is therefore, with the idle value b of the spindle speed n there,
///
///     y = b(n) + f (x A_c + A_e)      f = 2 pi n for power, 1 for torque
///
/// A_c and A_e are the mean torques of chip and edge that the given coefficients have there, both 0 in an air
/// cut, and x is the quotient of the true K_tc and the given one. The b of all speeds and the x of all
/// groups, pairs of a cutter and a material, come from one linear least-squares fit.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/forces/cutting_model.hpp"

namespace counterflex {

enum class SpindleChannel { power, torque };

struct SpindleSample {
  double key = 0;    ///< time (s), or line of the program
  double value = 0;  ///< W or N m
  int row = 0;       ///< line of the log
};

struct SpindleLog {
  std::string file;
  SpindleChannel channel = SpindleChannel::power;
  bool by_line = false;              ///< else by time
  double rapid_m_s = 0;              ///< speed of rapid moves; 0: they take no time
  std::optional<double> full_scale;  ///< largest value of the channel (W or N m)
  std::vector<SpindleSample> samples;
};

/// Reads a CSV of a header row and rows, with `t_s`, which increases, or `line`, and one of `power_W`,
/// `power_kW` and `torque_Nm`; other columns are not read. Settings are lines `# rapid_mm_min = VALUE` and
/// `# full_scale = VALUE` (unit of the channel); other lines that begin with `#` are comments. Throws
/// `InputError` (ErrorKind::machine_or_force) at the row. A channel is saturated, and refused, if it reaches
/// its full scale, or, where that is not given, if its largest value repeats in consecutive rows as no other
/// value does.
SpindleLog read_spindle_log(std::string_view text, const std::string& file);

/// What the spindle does along one move, in the order of the program.
struct SpindleMove {
  enum class Kind { air, cut, unknown };
  int line = 0;
  double seconds = 0;  ///< at the programmed feed, or at the log's speed of rapids
  Kind kind = Kind::unknown;
  double rpm = 0;
  std::size_t group = 0;                    ///< of a cut
  double chip_torque = 0, edge_torque = 0;  ///< of a cut, at the given coefficients (N m)
};

struct SpindleFit {
  struct Value {
    double value = 0, sigma = 0;
    std::size_t samples = 0;
  };
  struct Idle {
    double rpm = 0;
    Value value;  ///< W or N m
  };
  double offset = 0;  ///< s; the program begins at this time of the log
  double drift = 0;   ///< s; change of the offset along the program
  std::vector<Idle> idle;
  std::vector<Value> scales;  ///< x of each group; no samples: the group is not identified
  double residual = 0;        ///< rms (W or N m)
  double correlation = 0;     ///< of neighbouring residuals, 0 to 1; in the standard deviations
  std::size_t samples = 0;
};

/// Fits a log to the moves of a program, by the lines of its samples, or by their time, with the offset that
/// explains the log best. Samples within two intervals, and within the drift, of a place where the spindle
/// does something else are left out. Throws `InputError` (ErrorKind::machine_or_force) at a row of the log:
/// if it has no air cut at the speed of a cut, if its clock drifts, if it does not follow the program.
SpindleFit fit_spindle(const SpindleLog& log, const std::vector<SpindleMove>& moves, std::size_t groups);

/// A material that was fitted for a cutter.
struct FittedMaterial {
  std::string cutter, material;      ///< names in the file
  CuttingCoefficients coefficients;  ///< fitted: K_rc and K_ac in proportion to K_tc
  std::string comment;               ///< where it is from
};

/// The text of a file of cutting models (`file`, for messages) with a table of each fitted material, which
/// its sections name instead of the given material: C45 of T1 becomes [materials."C45 of T1"]. Throws
/// `InputError` if the text cannot take them.
std::string with_fitted_materials(std::string_view text, const std::string& file,
                                  const std::vector<FittedMaterial>& fitted);

}  // namespace counterflex
