#include "counterflex/report/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/report/run_tally.hpp"
#include "report/tally/causes.hpp"
#include "report/text/assumptions.hpp"
#include "report/text/control.hpp"
#include "report/text/tool_words.hpp"

namespace counterflex {

namespace {

// The run is still valid: that force does not act.
void list_unsolved(const UnderOtherForce& other, const char* change, Capped<Remark>& all) {
  if (other.unsolved == 0) return;
  const std::string places = other.unsolved == 1 ? "place" : "places";
  list(all, Remark{other.first_line,
                   fmt::format("with the force {} % {} the machine has no stable equilibrium here ({}; {} {} "
                               "in all): wear or an override may cause this",
                               std::lround(100 * force_change), change, to_string(other.status),
                               other.unsolved, places)});
}

void list_without_causes(const UnknownCauses& without, Capped<Remark>& all) {
  if (without.places == 0) return;
  list(all,
       Remark{without.first_line,
              fmt::format("the causes of the deviation are not known here ({} {} in all): with one of them "
                          "alone the machine has no stable equilibrium",
                          without.places, without.places == 1 ? "place" : "places")});
}

// A tilted tool whose tip is within the tolerance while its rim or flank is not.
void list_tilted(const RunReport& report, Capped<Remark>& all) {
  for (const ToolReport& tool : report.tools_off) {
    if (!tool.after || tool.after->tip_mm > report.tolerance_mm) continue;
    if (tool.after->largest_mm() <= report.tolerance_mm) continue;
    list(all, Remark{tool.after->line, tilt_in_words(tool, report.tolerance_mm)});
  }
}

Capped<Remark> all_warnings(const RunContext& context, const RunTally& tally, const RunReport& report) {
  Capped<Remark> all;
  for (const Remark& warning : context.facts.warnings) list(all, warning);
  for (const Remark& remark : context.program.remarks) list(all, remark);
  list(all, tally.contour_notes());
  list(all, tally.force_notes());
  list(all, tally.direction_notes());
  list_tilted(report, all);
  list_without_causes(report.without_causes, all);
  for (const Remark& warning : control_warnings(report.control, report.correction)) list(all, warning);
  return all;
}

ForceSummary force_summary(const RunTally& tally, const Measures& measures) {
  ForceSummary forces = tally.forces();
  forces.largest_N = measures.largest_N;
  forces.largest_Nm = measures.largest_Nm;
  return forces;
}

// Without solved waypoints there is no deviation; zeros would look like perfection.
std::optional<DeviationStatistics> known(const DeviationTally& tally) {
  if (tally.samples() == 0) return std::nullopt;
  return tally.statistics();
}

std::optional<Largest> known(const Largest& largest) {
  return largest.line > 0 || largest.mm > 0 ? std::optional(largest) : std::nullopt;
}

Sources sources(const Measures& measures, const Machine& machine) {
  Sources result{.superposition = measures.superposition.statistics()};
  for (const Cause& cause : all_causes) result.*cause.statistics = (measures.*cause.tally).statistics();
  if (!machine.fixture) result.fixture.reset();
  if (!weighs(machine)) result.gravity.reset();
  if (!(result.preloads->max_mm > 1e-9)) result.preloads.reset();
  return result;
}

UnderOtherForce under_other_force(const std::vector<LoadPlace>& places,
                                  const std::vector<OtherForce>& deviations) {
  UnderOtherForce result;
  DeviationTally tally;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Waypoint& w = places[i].at;
    const OtherForce& other = deviations[i];
    if (other.status == Status::converged)
      tally.add({other.deviation, w.direction, w.tool_axis, w.weight, w.line});
    else if (result.unsolved++ == 0)
      result.first_line = w.line, result.status = other.status;
  }
  result.deviation = tally.statistics();
  return result;
}

std::optional<double> percent_of(double part, double all) {
  return all > 0 ? std::optional(100 * part / all) : std::nullopt;
}

std::vector<OperationReport> operation_reports(const RunTally& tally, bool failed) {
  std::vector<OperationTally> tallies = tally.path().operations();
  const auto& names = tally.operation_names();
  tallies.resize(names.size());
  std::vector<OperationReport> rows;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const OperationTally& t = tallies[i];
    rows.push_back({names[i].tool, names[i].operation, t.first_line, t.last_line, t.moves, t.length_mm,
                    failed ? std::nullopt : percent_of(t.corrected_mm, t.length_mm), known(t.before),
                    known(t.after)});
  }
  return rows;
}

std::optional<CommonShift> common_shift(const RunContext& context, const Measures& measures) {
  CommonShift shift;
  for (const WorkFrame& frame : context.frames)
    if (frame.common_shift) shift.offsets.push_back({frame.name, *frame.common_shift / mm});
  if (shift.offsets.empty() || measures.rest.samples() == 0) return std::nullopt;
  shift.rest = measures.rest.statistics();
  return shift;
}

std::vector<ToolReport> tools_off(const Measures& measures, bool corrected) {
  std::vector<ToolReport> tools;
  for (const auto& [number, tool] : measures.tools)
    tools.push_back({tool.size, tool.before.largest(), corrected ? tool.after.largest() : std::nullopt});
  const auto size = [](const ToolReport& tool) {
    const auto& shown = tool.after ? tool.after : tool.before;
    return shown ? std::round(shown->largest_mm() / indistinct_mm) : 0;
  };
  std::stable_sort(tools.begin(), tools.end(),
                   [&](const ToolReport& a, const ToolReport& b) { return size(a) > size(b); });
  return tools;
}

// Parts of the report that all commands have.
RunReport common(const RunContext& context, const RunTally& tally, const Measures& measures,
                 const std::optional<Failure>& failure) {
  RunReport report;
  report.facts = context.facts;
  report.failure = failure;
  report.machine = context.machine.name;
  report.unmeasured = unmeasured_phrase(context.machine);
  report.method = context.options.method;
  report.tolerance_mm = context.options.tolerance / mm;
  report.path_mm = measures.path_mm;
  report.before = known(measures.before);
  if (context.facts.attribution) report.without_causes = measures.without_causes;
  // Statistics of some places alone would look like those of all.
  if (context.facts.attribution && report.before && report.without_causes.places == 0)
    report.sources = sources(measures, context.machine);
  report.at_worst = measures.at_worst;
  if (!failure) report.corrected_percent = percent_of(measures.corrected_mm, measures.path_mm);
  report.common_shift = common_shift(context, measures);
  report.operations = operation_reports(tally, failure.has_value());
  report.units = {tally.unit(), turns_joints(context.machine)};
  report.blocks.total = context.program.blocks;
  report.blocks.moves = context.program.moves;
  report.blocks.left_alone = context.program.left_alone;
  report.blocks.machine_positions = context.program.machine_positions;
  report.text_before = {context.program.blocks, context.program.bytes};
  report.forces = force_summary(tally, measures);
  const bool acts = report.forces.largest_N > 0 || report.forces.largest_Nm > 0;
  if (report.before && acts) report.sensitivity = {.without = measures.without_force.statistics()};
  report.control = control_facts(context.program, tally);
  report.work = work_in_words(context.machine, context.frames);
  report.datum = datum_in_words(context.machine, context.frames);
  report.tools = used_tools(context.machine, context.program.tools);
  report.tools_assumed = tools_in_words(report.tools, context.program.tools);
  report.gravity = gravity_in_words(context.machine);
  report.temperature_C = context.machine.temperature;
  report.thermal = thermal_in_words(context.machine);
  report.reversals = tally.reversals();
  for (const Corrected what : context.machine.already_corrects)
    report.already_corrected.emplace_back(corrected_names[static_cast<std::size_t>(what)]);
  report.not_modelled = not_modelled(context.machine);
  return report;
}

void add_residual(RunReport& report, const RunTally& tally, const Measures& measures) {
  report.after = known(measures.after);
  if (report.sources && report.after) report.air = known(measures.air);
  report.correction = known(measures.correction);
  report.worst = tally.path().worst(&WorstRow::after_mm);
  report.tools_off = tools_off(measures, true);
  if (tally.as_programmed()) report.as_programmed = tally.as_programmed()->found();
}

std::string nothing_reason(const BlockCounts& blocks) {
  if (blocks.moves == 0) return "the program has no moves";
  const auto& left = blocks.left_alone.rows;
  const std::string cause =
      left.empty() ? "" : fmt::format(" (line {}: {})", left.front().line, left.front().why);
  return "no feed move has a known position" + cause;
}

std::string reason_of(const RunReport& report) {
  switch (report.verdict) {
    case Verdict::ok:
    case Verdict::predicted:
      return "";
    case Verdict::partly:
      return partly_reason(report.feed_moves, report.tolerance_mm);
    case Verdict::nothing_corrected:
      return nothing_reason(report.blocks);
    case Verdict::failed:
      break;
  }
  return report.failure ? report.failure->what : "";
}

// A prediction writes no program: unknown positions are not a failure.
std::optional<ErrorKind> error_of(const RunReport& report) {
  switch (report.verdict) {
    case Verdict::ok:
    case Verdict::predicted:
      return std::nullopt;
    case Verdict::partly:
      if (report.facts.accept_partial || report.command == Command::predict) return std::nullopt;
      return ErrorKind::not_compensated;
    case Verdict::nothing_corrected:
      return ErrorKind::program_text;
    case Verdict::failed:
      break;
  }
  return report.failure ? report.failure->kind : ErrorKind::internal;
}

void add_verdict(RunReport& report, const RunTally& tally) {
  report.feed_moves = tally.feed_moves();
  if (report.command == Command::predict) {
    report.feed_moves.within += std::exchange(report.feed_moves.missed, 0);
    report.feed_moves.within_mm = report.path_mm;
  }
  report.verdict = report.failure ? Verdict::failed : verdict_of(report.feed_moves);
  if (report.command == Command::predict && report.verdict == Verdict::ok)
    report.verdict = Verdict::predicted;
  report.verdict_reason = reason_of(report);
  report.error_kind = error_of(report);
  if (report.error_kind) {
    report.facts.output.clear();
    report.facts.guard.reset();
  }
}

}  // namespace

double CommonShift::largest_mm() const {
  double largest = 0;
  for (const OfOffset& offset : offsets) largest = std::max(largest, offset.shift_mm.norm());
  return largest;
}

std::optional<Failure> refusal_of(const RunReport& report) {
  if (report.failure || !report.error_kind) return std::nullopt;
  const std::string_view end =
      report.command == Command::compensate ? "; no corrected program was written" : "";
  if (report.verdict == Verdict::nothing_corrected)
    return Failure{*report.error_kind, 0, fmt::format("NOTHING CORRECTED: {}{}", report.verdict_reason, end)};
  return Failure{*report.error_kind, report.feed_moves.missed > 0 ? report.feed_moves.worst_line : 0,
                 fmt::format("{}{}; give --accept-partial to accept this{}",
                             verdict_text(report.verdict, report.verdict_reason), end,
                             report.feed_moves.missed > 0 ? ", or a larger --tolerance-mm" : "")};
}

RunReport report_prediction(const RunContext& context, const RunTally& tally,
                            const std::optional<Failure>& failure) {
  const Measures measures = tally.path().measures();
  RunReport report = common(context, tally, measures, failure);
  report.command = Command::predict;
  report.tools_off = tools_off(measures, false);
  report.corrected_percent.reset();
  for (OperationReport& operation : report.operations) {
    operation.corrected_percent.reset();
    operation.after.reset();
  }
  report.worst = tally.path().worst(&WorstRow::before_mm);
  report.warnings = all_warnings(context, tally, report);
  add_verdict(report, tally);
  return report;
}

RunReport report_compensation(const RunContext& context, const RunTally& tally,
                              const std::optional<Failure>& failure) {
  const Measures measures = tally.path().measures();
  RunReport report = common(context, tally, measures, failure);
  report.command = Command::compensate;
  add_residual(report, tally, measures);
  report.blocks.corrected = tally.corrected_moves();
  report.blocks.others = tally.other_moves();
  report.blocks.inserted = tally.inserted_blocks();
  list(report.blocks.left_alone, tally.left_alone());
  if (!failure && tally.text_bytes() > 0)  // the text of a run that failed is cut
    report.text_after = TextSize{context.program.blocks + report.blocks.inserted, tally.text_bytes()};
  report.warnings = all_warnings(context, tally, report);
  add_verdict(report, tally);
  return report;
}

RunReport report_verification(const RunContext& context, const RunTally& tally, const Overview& corrected,
                              const std::optional<Failure>& failure) {
  const Measures measures = tally.path().measures();
  RunReport report = common(context, tally, measures, failure);
  report.command = Command::verify;
  add_residual(report, tally, measures);
  report.blocks.corrected = measures.segments_changed + tally.corrected_moves();
  list(report.blocks.left_alone, tally.left_alone());
  report.blocks.inserted = corrected.blocks - std::min(corrected.blocks, context.program.blocks);
  if (!failure) report.text_after = TextSize{corrected.blocks, corrected.bytes};
  report.warnings = all_warnings(context, tally, report);
  add_verdict(report, tally);
  return report;
}

UncertaintyReport uncertainty_report(const Machine& machine, const LoadPlace* worst,
                                     const std::optional<TipCovariance>& covariance) {
  UncertaintyReport report{*machine.uncertainty, uncertain_parameters(machine).names.size(),
                           parameters(machine).size()};
  if (worst == nullptr || !covariance) return report;
  const Matrix3 all = covariance->sum().topLeftCorner<3, 3>();
  const Vector3 u = band_direction(worst->at.before.head<3>(), all);
  const auto band_mm = [&](const Matrix6& C) {
    return 2 * std::sqrt(std::max(u.dot(C.topLeftCorner<3, 3>() * u), 0.0)) / mm;
  };
  report.at_worst = {band_mm(covariance->parameters), band_mm(covariance->force), band_mm(covariance->others),
                     band_mm(covariance->sum())};
  return report;
}

void add_sensitivity(RunReport& report, const std::vector<LoadPlace>& places,
                     const std::vector<OtherForce>& higher, const std::vector<OtherForce>& lower,
                     const std::vector<OtherForce>& without) {
  if (!report.sensitivity) return;
  report.sensitivity->without = under_other_force(places, without).deviation;
  if (report.facts.attribution && report.after)
    report.air = Largest{report.sensitivity->without.max_mm, report.sensitivity->without.max_line};
  add_sensitivity(report, places, higher, lower);
}

void add_sensitivity(RunReport& report, const std::vector<LoadPlace>& places,
                     const std::vector<OtherForce>& higher, const std::vector<OtherForce>& lower) {
  if (!report.sensitivity) return;
  report.sensitivity->higher = under_other_force(places, higher);
  report.sensitivity->lower = under_other_force(places, lower);
  list_unsolved(report.sensitivity->higher, "higher", report.warnings);
  list_unsolved(report.sensitivity->lower, "lower", report.warnings);
}

}  // namespace counterflex
