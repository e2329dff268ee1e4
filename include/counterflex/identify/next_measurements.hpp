#pragma once
/// How uncertain the deviations of a program are, and which measurements would shrink that most.
#include <string>
#include <vector>

#include "counterflex/identify/measurements.hpp"

namespace counterflex {

struct Identification;

/// A place of the program's feed moves, and its share of their length.
struct ProgramPlace {
  CommandedState state;
  double weight = 1;
};

/// A measurement that was not made yet.
struct NextMeasurement {
  MeasurementKind kind = MeasurementKind::static_push;
  std::string what;        ///< "static_push along x with 300 N at X 300, Y 200, Z -250 mm"
  Measurement row;         ///< its value is 0
  double sigma_after = 0;  ///< of the program, after it and those before it (m)
};

/// Deviations of the tip's position along a program: the root of the mean of their variances, which come from
/// the covariance of the parameters. They are without the mean deviation of the unloaded machine, which
/// touching off removes.
struct ProgramUncertainty {
  std::string program;
  double sigma = 0;                   ///< m, now
  std::vector<NextMeasurement> next;  ///< the best first; each with those before it
};

/// Those of an identification, and the parameters that it did not vary with their deviations in the machine
/// file; harmonics only where it states them.
KnownParameters known_parameters(const Identification& found);

/// Measurements that could be made: pushes along x, y and z and tracker points at states of `machine` around
/// the program and over its travel, and the rows of `given` without unknown frames again. A tracker point
/// counts as measured in a known frame. Deviations of rows are those of the rows given, or the default ones.
std::vector<NextMeasurement> candidate_measurements(const Machine& machine, const Measurements& given,
                                                    const std::vector<ProgramPlace>& program);

/// Chooses `count` of the candidates one after the other, each the one that leaves the least mean variance:
///
///     C' = C - C H' (1 + H C H')^-1 H C        H: tangents of the row by the parameters, in its deviations
///
/// A candidate may be chosen more than once. States that the machine cannot reach are left out.
ProgramUncertainty next_measurements(const Machine& machine, const KnownParameters& known,
                                     const std::vector<ProgramPlace>& program,
                                     std::vector<NextMeasurement> candidates, int count, int threads);

}  // namespace counterflex
