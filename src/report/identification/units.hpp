#pragma once
/// Names and units of an identification's results.
#include <cmath>
#include <string>
#include <string_view>

#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/identify.hpp"

namespace counterflex {

inline std::string_view name_of(ParameterSet set) {
  switch (set) {
    case ParameterSet::zeros:
      return "zeros";
    case ParameterSet::geometry:
      return "geometry";
    case ParameterSet::compliance:
      return "compliance";
    case ParameterSet::mass:
      return "mass";
    case ParameterSet::reversal:
      return "reversal";
    case ParameterSet::tables:
      return "tables";
    case ParameterSet::harmonics:
      return "harmonics";
  }
  return "";
}

/// SI; 0 where all digits are rounding.
inline double shown_value(const IdentifiedParameter& p) {
  return std::abs(p.value) <= 1e-6 * p.sigma ? 0 : p.value;
}

/// "C moves axis A2 from -120 to 10 deg; in the other rows it moves from -100 to -20 deg"
std::string range_words(const LeftRange& left);

/// Why a set was not tested, and the parameters that stay all the same.
std::string untested_words(const LadderStep& step);

/// "a reading scatters by 0.054 mm (120 repeats) ..."
std::string noise_words(const SessionNoise& noise);

/// The residuals of a fit in words: "0.004 mm rms of all lengths, 1.1 of the stated deviations".
std::string residual_words(const Identification& found);

struct ErrorUnit {
  std::string_view name;
  double si;
};

/// Of errors of rows of a kind; `is_length` is that of the rows' values.
inline ErrorUnit unit_of(MeasurementKind kind, bool is_length) {
  switch (kind) {
    case MeasurementKind::squareness:
    case MeasurementKind::scale:
      return {"um/m", 1e-6};
    case MeasurementKind::static_push:
    case MeasurementKind::hung_weight:
    case MeasurementKind::axis_position:
    case MeasurementKind::axis_table:
    case MeasurementKind::reversal:
    case MeasurementKind::clamped_torque:
    case MeasurementKind::cmm_feature:
      return is_length ? ErrorUnit{"um", um} : ErrorUnit{"mdeg", 1e-3 * deg};
    default:
      return {"mm", mm};
  }
}

}  // namespace counterflex
