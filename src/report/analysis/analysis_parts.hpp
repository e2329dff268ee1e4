#pragma once
/// The optional parts of an analysis as JSON and as text.
#include <string>

#include "counterflex/report/analysis.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

inline constexpr int analysis_digits = 9;  ///< 1e-9 mm, deg, N, N m
inline constexpr int analysis_significant_digits = 12;

/// `analyze --full`, `--hold` and `--curve`.
Json details_json(const std::vector<ChainDetail>& chains);
Json held_json(const HeldPose& held);
Json curve_json(const ForceCurve& curve);

std::string details_text(const AnalysisReport& report);
std::string held_text(const AnalysisReport& report);
std::string curves_text(const AnalysisReport& report);

/// What of the machine file acts beside the stated load: "the machine's own weight and preloads"; or empty.
std::string own_loads(const AnalysisReport& report);

/// "5 spring rx": the name of a coordinate in tables and rows of matrices.
std::string name_of(const CoordinateDetail& coordinate);

/// A 6x6 matrix, and lists of six numbers.
Json six_json(const Vector6& values);
Json matrix_json(const Matrix6& K);

}  // namespace counterflex
