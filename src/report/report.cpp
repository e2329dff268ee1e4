#include "counterflex/report/report.hpp"

#include <algorithm>

#include "assumptions.hpp"
#include "control.hpp"
#include "counterflex/geometry/units.hpp"
#include "measure.hpp"

namespace counterflex {

namespace {

constexpr std::size_t worst_rows = 10;

// Ordered by line; what has none (0) comes first.
template <typename T>
Capped<T> listed(std::vector<T> all) {
  std::stable_sort(all.begin(), all.end(), [](const T& a, const T& b) { return a.line < b.line; });
  Capped<T> list;
  list.count = all.size();
  all.resize(std::min(all.size(), listed_at_most));
  list.rows = std::move(all);
  return list;
}

std::vector<WorstRow> worst(std::vector<WorstRow> rows, double WorstRow::*key) {
  const auto worse = [&](const WorstRow& a, const WorstRow& b) { return a.*key > b.*key; };
  std::stable_sort(rows.begin(), rows.end(), worse);
  rows.resize(std::min(rows.size(), worst_rows));
  return rows;
}

std::vector<Remark> all_warnings(const Job& job, const RunReport& report) {
  std::vector<Remark> all = report.facts.warnings;
  all.insert(all.end(), job.program.remarks.begin(), job.program.remarks.end());
  for (const ForceNote& note : job.forces.notes()) all.push_back({note.line, note.what});
  const auto of_control = control_warnings(report.control, report.correction);
  all.insert(all.end(), of_control.begin(), of_control.end());
  return all;
}

ForceSummary force_summary(const Job& job, const Measures& measures) {
  return {measures.largest_N, measures.largest_Nm, job.forces.ramps(), job.forces.jumps(),
          job.forces.largest_step_N()};
}

// A run that failed before anything was solved has no deviations; zeros would look like perfection.
std::optional<DeviationStatistics> known(const DeviationTally& tally, const std::optional<Failure>& failure) {
  if (tally.samples() == 0 && failure) return std::nullopt;
  return tally.statistics();
}

// What all commands report alike.
RunReport common(const Machine& machine, const Job& job, const RunFacts& facts, const Measures& measures,
                 const std::optional<Failure>& failure) {
  RunReport report;
  report.facts = facts;
  report.failure = failure;
  report.machine = machine.name;
  report.method = job.options.method;
  report.tolerance_mm = job.options.tolerance / mm;
  report.path_mm = measures.path_mm;
  report.before = known(measures.before, failure);
  if (facts.attribution && report.before)
    report.sources = Sources{measures.geometry.statistics(), measures.load.statistics(),
                             measures.superposition.statistics()};
  report.blocks.total = job.program.block_count;
  report.blocks.moves = job.program.moves.size();
  report.text_before = {job.program.block_count, job.program.text.size()};
  report.forces = force_summary(job, measures);
  report.work = work_in_words(machine, job);
  report.datum = datum_in_words(machine, job);
  return report;
}

// Once everything else is known.
void add_control(RunReport& report, const Job& job, const std::string* corrected) {
  report.control = control_facts(job, report.facts, corrected);
  report.warnings = listed(all_warnings(job, report));
}

void add_residual(RunReport& report, const Measures& measures) {
  report.after = known(measures.after, report.failure);
  if (report.facts.attribution && report.after) report.air = measures.air;
  report.correction = measures.correction;
  report.worst = worst(measures.by_line, &WorstRow::after_mm);
}

}  // namespace

RunReport report_prediction(const Machine& machine, const Job& job, const RunFacts& facts,
                            const std::vector<Waypoint>& waypoints, const std::optional<Failure>& failure) {
  const Measures measures = measure(waypoints);
  RunReport report = common(machine, job, facts, measures, failure);
  report.command = Command::predict;
  report.worst = worst(measures.by_line, &WorstRow::before_mm);
  report.blocks.left_alone = listed(job.program.left_alone);
  add_control(report, job, nullptr);
  return report;
}

RunReport report_compensation(const Machine& machine, const Job& job, const RunFacts& facts,
                              const Compensation& compensation) {
  const Measures measures = measure(compensation.waypoints);
  RunReport report = common(machine, job, facts, measures, compensation.failure);
  report.command = Command::compensate;
  add_residual(report, measures);
  report.correction = Largest{compensation.largest_correction / mm, compensation.largest_correction_line};
  report.blocks.corrected = compensation.corrected_moves;
  report.blocks.inserted = compensation.counts.inserted_blocks;
  std::vector<LeftAlone> left_alone = job.program.left_alone;
  left_alone.insert(left_alone.end(), compensation.left_alone.begin(), compensation.left_alone.end());
  report.blocks.left_alone = listed(std::move(left_alone));
  if (!compensation.text.empty())
    report.text_after = TextSize{job.program.block_count + report.blocks.inserted, compensation.text.size()};
  add_control(report, job, compensation.text.empty() ? nullptr : &compensation.text);
  return report;
}

RunReport report_verification(const Machine& machine, const Job& job, const RunFacts& facts,
                              const Program& corrected, const std::vector<Waypoint>& waypoints,
                              const std::optional<Failure>& failure) {
  const Measures measures = measure(waypoints);
  RunReport report = common(machine, job, facts, measures, failure);
  report.command = Command::verify;
  add_residual(report, measures);
  report.blocks.corrected = measures.segments_changed;
  report.blocks.inserted = corrected.block_count - std::min(corrected.block_count, job.program.block_count);
  report.blocks.left_alone = listed(job.program.left_alone);
  report.text_after = TextSize{corrected.block_count, corrected.text.size()};
  add_control(report, job, &corrected.text);
  return report;
}

}  // namespace counterflex
