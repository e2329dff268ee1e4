#pragma once
/// Causes of a deviation, as reports show them.
#include <array>
#include <string_view>

#include "counterflex/compensation/options.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/report.hpp"
#include "counterflex/report/run_tally.hpp"

namespace counterflex {

/// The part of the superposition that is caused by preloads alone (m, rad). Values below 1e-12 m are rounding
/// and become zero.
inline Vector6 preloads_of(const Causes& causes) {
  const Vector6 rest = causes.superposition - causes.geometry - causes.load - causes.fixture - causes.gravity;
  return rest.cwiseAbs().maxCoeff() < 1e-12 ? Vector6(Vector6::Zero()) : rest;
}

/// A cause, and where each part of a report has it. The causes add up to the superposition.
struct Cause {
  std::string_view name;      ///< in JSON keys, in names of columns and curves
  const char* words;          ///< of its row in a table
  std::string_view in_short;  ///< in the summary on a terminal
  Vector6 (*of)(const Causes&);
  bool is_of_all_machines;  ///< otherwise an output has it only for a machine where it acts
  Quantity curve;           ///< its component in x
  DeviationTally Measures::*tally;
  std::optional<DeviationStatistics> Sources::*statistics;
  Vector3 SourcesAtWorst::*at_worst_mm;
  double DeviationParts::*size_mm;
};

/// All causes, in the order of all outputs. An output lists them by this table.
inline constexpr std::array<Cause, 5> all_causes{{
    {"geometry", "geometry: errors of assembly alone", "assembly",
     [](const Causes& causes) { return causes.geometry; }, true, Quantity::geometry_x, &Measures::geometry,
     &Sources::geometry, &SourcesAtWorst::geometry_mm, &DeviationParts::geometry_mm},
    {"load", "load: cutting forces alone", "force", [](const Causes& causes) { return causes.load; }, true,
     Quantity::load_x, &Measures::load, &Sources::load, &SourcesAtWorst::load_mm, &DeviationParts::load_mm},
    {"fixture", "fixture: deflection of the part", "fixture",
     [](const Causes& causes) { return causes.fixture; }, false, Quantity::fixture_x, &Measures::fixture,
     &Sources::fixture, &SourcesAtWorst::fixture_mm, &DeviationParts::fixture_mm},
    {"gravity", "gravity: weights alone", "weight", [](const Causes& causes) { return causes.gravity; },
     false, Quantity::gravity_x, &Measures::gravity, &Sources::gravity, &SourcesAtWorst::gravity_mm,
     &DeviationParts::gravity_mm},
    {"preloads", "preloads alone", "preloads", preloads_of, false, Quantity::preloads_x, &Measures::preloads,
     &Sources::preloads, &SourcesAtWorst::preloads_mm, &DeviationParts::preloads_mm},
}};

}  // namespace counterflex
