#pragma once
/// Finds the parameters of a machine that fit measurements best.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/identify/measurements.hpp"
#include "counterflex/identify/next_measurements.hpp"
#include "counterflex/machine/parameters.hpp"

namespace counterflex {

/// Sets of parameters, in the order in which they are tried.
enum class ParameterSet {
  zeros,     ///< components of errors along or about the axis of the actuator before them
  geometry,  ///< all components of errors
  compliance,
  mass,
  reversal,   ///< lost motion of actuators; rows need directions of motion
  tables,     ///< positioning errors of error tables that state their deviation
  harmonics,  ///< of rotary actuators that have the key
};

/// Which rows test a fit that was made without them.
enum class HoldOut {
  automatic,  ///< sessions where there are several of a kind, else a fifth
  session,    ///< each session in turn
  region,     ///< each of four regions of the workspace in turn
  fifth,      ///< each fifth of the rows in turn
};

/// Symmetric, and positive definite in units of its own deviations.
bool is_covariance(const Eigen::MatrixXd& matrix);

struct IdentifyOptions {
  std::vector<ParameterSet> sets = {ParameterSet::zeros,    ParameterSet::geometry, ParameterSet::compliance,
                                    ParameterSet::reversal, ParameterSet::tables,   ParameterSet::harmonics};
  HoldOut hold_out = HoldOut::automatic;
  /// A set stays only where held-out rows improve. Without them tables and harmonics are left out.
  bool ladder = true;
  KnownParameters
      prior{};  ///< of an earlier fit, in place of the machine file's deviations of its parameters
  int threads = 1;
};

/// One parameter after the fit. SI.
struct IdentifiedParameter {
  std::string name;
  ParameterKind kind = ParameterKind::position;
  double unit = 1;  ///< of the name's unit, in SI
  double before = 0, value = 0;
  double prior = 0;               ///< standard deviation before the fit
  double sigma = 0;               ///< after it
  bool is_default_prior = false;  ///< the machine file states none
  bool is_identified = false;     ///< the data have more than halved its deviation
};

/// Errors of rows: distances, gauge readings in m; angles in rad; scales in m/m.
struct ErrorSummary {
  std::size_t count = 0;
  double mean = 0, rms = 0, p95 = 0, largest = 0;
};

/// Rows of one session that a fit did not see, before (the machine file) and after.
struct HeldOutGroup {
  std::string name;  ///< session, region or part
  MeasurementKind kind = MeasurementKind::tracker_point;
  bool is_length = true;  ///< of `before` and `after`
  ErrorSummary before, after;
  ErrorSummary angle_before, angle_after;  ///< of orientations; count 0: none
  double in_interval = 0;  ///< share of the measured numbers that lie in their predicted 95 % intervals
};

/// A held-out group moves an actuator beyond the range that it has in the other rows. Of shown values (m,
/// rad).
struct LeftRange {
  std::string group, actuator;  ///< as `actuator_names` has it
  bool turns = false;
  double trained_min = 0, trained_max = 0, tested_min = 0, tested_max = 0;
};

/// A set of parameters that was tried.
struct LadderStep {
  ParameterSet set;
  double before = 0, after = 0;  ///< mean error of held-out rows without it and with it (m)
  double gain = 0;               ///< share of the error that it removes, mean of the groups
  double gain_scatter = 0;       ///< standard error of that mean
  bool is_kept = false;
  std::optional<LeftRange> left{};  ///< of tables and harmonics: then they are not kept
  bool is_tested = false;           ///< rows of two groups show what fits without them predict; else no gain
  /// Parameters of a set that is not kept which stay, because rows show them that the other rows cannot test.
  std::vector<std::string> untested{};
};

/// Noise of a session from repeated readings, and what its rows miss beyond that. Of positions these are
/// distances in space, of gauges values (m, rms).
struct SessionNoise {
  std::string session;
  MeasurementKind kind = MeasurementKind::tracker_point;
  double noise = 0;           ///< scatter of one reading about the mean of its place
  int freedoms = 0;           ///< readings less places
  double misfit = 0;          ///< of the fit: residuals of the means of places
  double noise_of_means = 0;  ///< the part of the noise in them
  double lack_of_fit = 0;     ///< the part that noise does not explain
  bool is_lacking = false;    ///< more than chance explains (F test, 1 %)
};

/// A row whose error is far outside that of its kind.
struct Outlier {
  Location at;
  std::string session;
  double error = 0;  ///< m
  double ratio = 0;  ///< to the robust deviation of its session
};

struct Correlation {
  std::string a, b;
  double value = 0;
};

/// Changes of parameters that, made together, change no row by much: the measurements leave more than half of
/// the prior deviation of this combination.
struct FreeCombination {
  struct Term {
    std::string name;
    double change = 0;  ///< SI; of the first term one prior deviation
  };
  std::vector<Term> terms;  ///< at least two
};

struct Identification {
  std::vector<IdentifiedParameter> parameters;  ///< those that were varied
  Eigen::MatrixXd covariance;                   ///< SI, in the same order
  std::vector<LadderStep> ladder;
  std::vector<HeldOutGroup> held_out;
  std::size_t untested_rows = 0;  ///< held out, but the other rows do not determine what they show
  std::vector<Outlier> outliers;  ///< left out of the fit; the farthest 50
  std::size_t outlier_count = 0;
  std::vector<Location> worst;
  std::vector<Correlation> correlations;  ///< above 0.9
  std::vector<FreeCombination> free;
  std::vector<SessionNoise> noise;      ///< of sessions with repeated readings
  std::optional<double> repeatability;  ///< m: rms scatter of repeated readings of all sessions
  std::optional<double> lack_of_fit;    ///< m: rms of the residuals of positions and lengths
  std::optional<double> misfit;         ///< of all rows that state their deviations, in units of these
  int iterations = 0;
  bool is_converged = false;
  Machine machine;                            ///< with the identified values
  std::optional<ProgramUncertainty> program;  ///< where it was asked for
};

/// Throws `InputError` (ErrorKind::machine_or_force) where the measurements cannot determine a fit: too few
/// rows in a session, states that do not differ, states that the machine cannot reach.
Identification identify(const Machine& machine, const Measurements& measurements,
                        const IdentifyOptions& options);

/// The text of a machine file with the identified values and standard deviations in its table [parameters].
/// All other lines stay. `text` is the file that was read; `file` names it; `files` are the measurements, for
/// notes.
std::string with_identified(std::string_view text, const std::string& file, const Identification& found,
                            const std::string& files);

}  // namespace counterflex
