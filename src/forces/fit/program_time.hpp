#pragma once
/// The spindle along the time of a program, and the offset of a log to it.
#include <vector>

#include "counterflex/forces/spindle_fit.hpp"

namespace counterflex {

/// Moves behind one another in time; those that do the same are one.
class ProgramTime {
 public:
  ProgramTime(const SpindleLog& log, const std::vector<SpindleMove>& moves);

  double duration() const { return ends_.empty() ? 0 : ends_.back(); }

  /// The move at time t (s); null outside of the program.
  const SpindleMove* at(double t) const;

  /// Time to the nearest change of what the spindle does, the ends of the program included.
  double to_change(double t) const;

  /// The value that the coefficients have at t, without idle; 0 outside, NaN in a move with an unknown
  /// torque.
  double value(double t) const;

 private:
  std::size_t index(double t) const;

  SpindleChannel channel_;
  std::vector<SpindleMove> moves_;
  std::vector<double> ends_;  ///< s
};

/// f: what a torque counts in the channel at a spindle speed (1/s or 1).
double per_torque(SpindleChannel channel, double rpm);

/// The median interval of the samples of a log by time (s).
double interval_of(const SpindleLog& log);

/// The time of the log at which the program begins: where the log correlates best with the program.
double find_offset(const SpindleLog& log, const ProgramTime& program);

/// The same near an offset, to a fraction of the interval.
double refine_offset(const SpindleLog& log, const ProgramTime& program, double offset);

/// By how much the best offset changes along the program (s), followed from part to part. A part without a
/// change of the cut keeps that of its neighbour.
double drift_of(const SpindleLog& log, const ProgramTime& program, double offset);

}  // namespace counterflex
