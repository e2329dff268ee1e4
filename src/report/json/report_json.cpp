#include <fmt/core.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/formats.hpp"
#include "report/json/json_numbers.hpp"
#include "report/json/loads_json.hpp"
#include "report/json/proof_json.hpp"
#include "report/json/summary_json.hpp"
#include "report/json/uncertainty_json.hpp"
#include "report/names.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {

namespace {

constexpr int digits = 7;  // 1e-7 mm, 1e-7 deg

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json result = Json::object();
  for (const InputFile& input : inputs) result[input.name] = {{"path", input.path}, {"sha256", input.sha256}};
  return result;
}

/// An option that is given several times has a list of values.
Json options_json(const std::vector<OptionValue>& options) {
  Json result = Json::object();
  const auto add = [&](const std::string& name, const Json& value) {
    if (!result.contains(name)) return void(result[name] = value);
    if (!result[name].is_array()) result[name] = Json::array({result[name]});
    result[name].push_back(value);
  };
  for (const OptionValue& option : options)
    std::visit([&](const auto& value) { add(option.name, value); }, option.value);
  return result;
}

/// Unknown values are null, not zero.
Json feed_moves_json(const RunReport& report) {
  const FeedMoves& moves = report.feed_moves;
  const bool judged = report.command != Command::predict;
  const auto of_judged = [&](const Json& value) { return judged ? value : Json(nullptr); };
  const bool solved = judged && moves.worst_line > 0;
  return {{"count", moves.count},
          {"within", of_judged(moves.within)},
          {"missed", of_judged(moves.missed)},
          {"unknown", moves.unknown},
          {"unknown_length", moves.unknown_length},
          {"length_mm", number(moves.length_mm, digits)},
          {"within_mm", of_judged(number(moves.within_mm, digits))},
          {"worst_mm", solved ? number(moves.worst_mm, digits) : Json(nullptr)},
          {"worst_line", solved ? Json(moves.worst_line) : Json(nullptr)}};
}

Json without_force_json(const WithoutForce& without) {
  const auto length = [](const auto& sum) {
    return sum.moves > 0 && sum.unknown_length == sum.moves ? Json(nullptr) : number(sum.length_mm, digits);
  };
  Json reasons = Json::array(), rows = Json::array();
  for (const WithoutForceReason& reason : without.reasons)
    reasons.push_back({{"why", reason.why},
                       {"moves", reason.moves},
                       {"unknown_length", reason.unknown_length},
                       {"length_mm", length(reason)},
                       {"first_line", reason.first_line}});
  for (const WithoutForceRow& row : without.rows.rows)
    rows.push_back({{"line", row.line}, {"length_mm", number(row.length_mm, digits)}, {"why", row.why}});
  return {{"moves", without.moves},
          {"unknown_length", without.unknown_length},
          {"length_mm", length(without)},
          {"reasons", std::move(reasons)},
          {"rows", std::move(rows)}};
}

Json forces_json(const RunReport& report) {
  const ForceSummary& forces = report.forces;
  const auto known = [&](double value) { return report.before ? number(value, 4) : Json(nullptr); };
  Json json = {{"largest_N", known(forces.largest_N)},
               {"largest_Nm", known(forces.largest_Nm)},
               {"ramps", forces.ramps},
               {"jumps", forces.jumps},
               {"largest_step_N", number(forces.largest_step_N, 4)},
               {"without_force", without_force_json(forces.without)}};
  if (forces.at_platform) json["wrench_at"] = "platform";
  return json;
}

Json left_alone_json(const Capped<LeftAlone>& blocks) {
  Json rows = Json::array();
  for (const LeftAlone& block : blocks.rows) rows.push_back({{"line", block.line}, {"why", block.why}});
  return rows;
}

Json blocks_json(const RunReport& report) {
  const BlockCounts& blocks = report.blocks;
  const bool is_known = report.command != Command::predict && !report.failure;
  const auto known = [&](std::size_t count) { return is_known ? Json(count) : Json(nullptr); };
  const auto others = [&](std::size_t OtherMoves::*count) {
    return blocks.others ? known(*blocks.others.*count) : Json(nullptr);
  };
  return {{"total", blocks.total},
          {"moves", blocks.moves},
          {"corrected", known(blocks.corrected)},
          {"corrected_in_part", others(&OtherMoves::in_part)},
          {"grouped", others(&OtherMoves::grouped)},
          {"held", others(&OtherMoves::held)},
          {"not_corrected", others(&OtherMoves::left)},
          {"inserted", known(blocks.inserted)},
          {"left_alone_count", blocks.left_alone.count},
          {"left_alone", left_alone_json(blocks.left_alone)},
          {"machine_positions_count", blocks.machine_positions.count},
          {"machine_positions", left_alone_json(blocks.machine_positions)}};
}

Json text_json(const RunReport& report) {
  const auto& after = report.text_after;
  return {{"blocks_before", report.text_before.blocks},
          {"blocks_after", after ? Json(after->blocks) : Json(nullptr)},
          {"bytes_before", report.text_before.bytes},
          {"bytes_after", after ? Json(after->bytes) : Json(nullptr)}};
}

Json short_blocks_json(const std::optional<ShortBlocks>& blocks) {
  if (!blocks) return nullptr;
  const bool any = blocks->count > 0;
  return {{"limit_ms", number(blocks->limit_ms, 6)},
          {"count", blocks->count},
          {"first_line", any ? Json(blocks->first_line) : Json(nullptr)},
          {"shortest_ms", any ? number(blocks->shortest_ms, 6) : Json(nullptr)},
          {"shortest_line", any ? Json(blocks->shortest_line) : Json(nullptr)}};
}

Json lines_json(const std::optional<LineLengths>& lines) {
  if (!lines || lines->limit == 0) return nullptr;
  return {{"limit", lines->limit},
          {"longest", lines->longest},
          {"longest_line", lines->longest_line},
          {"near_limit", lines->near}};
}

Json zones_json(const Zones& zones) {
  if (zones.count == 0) return nullptr;
  const bool any = zones.largest_mm > 0;
  return {{"count", zones.count},
          {"largest_mm", any ? number(zones.largest_mm, 6) : Json(nullptr)},
          {"largest_line", any ? Json(zones.largest_line) : Json(nullptr)}};
}

Json control_json(const ControlFacts& control) {
  Json tolerances = Json::array();
  for (const PathTolerance& t : control.tolerances)
    tolerances.push_back({{"line", t.line},
                          {"path_mm", optional_number(t.path_mm)},
                          {"merge_mm", optional_number(t.merge_mm)}});
  return {{"short_blocks", short_blocks_json(control.short_blocks)},
          {"lines", lines_json(control.lines)},
          {"zones", zones_json(control.zones)},
          {"path_tolerances", std::move(tolerances)},
          {"plunges", control.plunges},
          {"rapids", control.rapids}};
}

Json warnings_json(const std::vector<Remark>& warnings) {
  Json list = Json::array();
  for (const Remark& warning : warnings) list.push_back({{"line", warning.line}, {"what", warning.what}});
  return list;
}

Json operations_json(const std::vector<OperationReport>& operations) {
  Json list = Json::array();
  for (const OperationReport& operation : operations)
    list.push_back({{"tool", operation.tool},
                    {"operation", operation.name},
                    {"first_line", operation.first_line},
                    {"last_line", operation.last_line},
                    {"moves", operation.moves},
                    {"length_mm", number(operation.length_mm, digits)},
                    {"corrected_percent", optional_number(operation.corrected_percent)},
                    {"before", optional_statistics(operation.before)},
                    {"after", optional_statistics(operation.after)}});
  return list;
}

Json parts_json(const std::optional<DeviationParts>& parts, const std::optional<Sources>& sources) {
  if (!parts) return nullptr;
  Json json = {{"geometry_mm", nullptr},
               {"load_mm", nullptr},
               {"gravity_mm", nullptr},
               {"preloads_mm", nullptr},
               {"discrepancy_mm", number(parts->discrepancy_mm, digits)}};
  for (const Cause& cause : all_causes)
    if (sources && (*sources).*cause.statistics)
      json[fmt::format("{}_mm", cause.name)] = number((*parts).*cause.size_mm, digits);
  return json;
}

/// The place of a row is the place of the deviation that orders the rows.
Json worst_row_json(const RunReport& report, const WorstRow& row) {
  const WorstPlace& place = report.after ? row.at_after : row.at_before;
  Json json = {{"line", row.line},
               {"before_mm", number(row.before_mm, digits)},
               {"after_mm", report.after ? number(row.after_mm, digits) : Json(nullptr)},
               {"s_mm", number(place.s_mm, digits)},
               {"place_mm", numbers(place.place_mm, digits)},
               {"force_N", number(place.force_N, 4)},
               {"causes", parts_json(row.causes, report.sources)},
               {"text", row.text}};
  if (row.at_before.band_mm) json["before_band_mm"] = number(*row.at_before.band_mm, digits);
  if (report.after && row.at_after.band_mm) json["after_band_mm"] = number(*row.at_after.band_mm, digits);
  if (report.command == Command::verify) json["corrected_line"] = place.corrected_line;
  if (place.operation < 0) return json;
  const OperationReport& operation = report.operations[static_cast<std::size_t>(place.operation)];
  json["tool"] = operation.tool;
  json["operation"] = operation.name;
  return json;
}

Json worst_json(const RunReport& report) {
  Json list = Json::array();
  for (const WorstRow& row : report.worst) list.push_back(worst_row_json(report, row));
  return list;
}

/// The usual unit of lengths for this program and machine.
Json units_json(const ShownUnits& units) {
  const bool inch = units.program == LengthUnit::inches;
  return {{"program", inch ? "inch" : "mm"}, {"shown", inch ? "inch" : units.revolute ? "mm" : "um"}};
}

Json assumptions_json(const RunReport& report) {
  Json json = {{"work", report.work}, {"datum", report.datum}};
  if (!report.unmeasured.empty()) json["unmeasured"] = report.unmeasured;
  if (!report.tools.empty()) json["tools"] = report.tools_assumed;
  if (!report.gravity.empty()) json["gravity"] = report.gravity;
  if (!report.thermal.empty()) json["thermal"] = report.thermal;
  if (!report.already_corrected.empty()) json["already_corrected"] = report.already_corrected;
  json["not_modelled"] = report.not_modelled;
  return json;
}

Json reversals_json(const Capped<ReversalRow>& reversals) {
  Json rows = Json::array();
  for (const ReversalRow& row : reversals.rows) rows.push_back({{"line", row.line}, {"axis", row.axis}});
  return {{"count", reversals.count}, {"rows", std::move(rows)}};
}

Json sanity_json(const SanityChecks& checks) {
  Json list = Json::array();
  for (const SanityCheck& check : checks)
    list.push_back({{"check", check.name}, {"state", to_string(check.state)}, {"text", check.text}});
  return list;
}

Json tools_json(const std::vector<UsedTool>& tools) {
  Json list = Json::array();
  for (const UsedTool& tool : tools)
    list.push_back({{"number", tool.number},
                    {"length_mm", optional_number(tool.length_mm)},
                    {"radial_N_per_um", optional_number(tool.radial_N_per_um)},
                    {"stiffness", tool.stiffness}});
  return list;
}

/// The name of a kind of error: `failure` `kind` of the guide.
const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::internal:
      return "internal";
    case ErrorKind::usage:
      return "usage";
    case ErrorKind::program_text:
      return "program";
    case ErrorKind::machine_or_force:
      return "machine_or_force";
    case ErrorKind::not_compensated:
      return "not_compensated";
    case ErrorKind::limit:
      return "limit";
    case ErrorKind::transient_io:
      return "transient";
  }
  return "internal";
}

Json failure_json(const RunReport& report) {
  const std::optional<Failure>& failure = report.failure;
  if (!failure) return nullptr;
  Json json{{"exit", report.exit_status},
            {"kind", name_of(failure->kind)},
            {"line", failure->line},
            {"what", failure->what}};
  if (report.command == Command::verify) json["corrected_line"] = failure->corrected_line;
  if (const auto& at = report.failure_place)
    json["at"] = sources_at_json(*at, [&](const Cause& cause) {
      return cause.is_of_all_machines || !((*at).*cause.at_worst_mm).isZero(0);
    });
  return json;
}

}  // namespace

std::string to_json(const SanityChecks& checks) {
  return dump(sanity_json(checks));
}

namespace {

Json guard_json(const WrittenGuard& written) {
  const Guard& guard = written.guard;
  const Vector3& shown = guard.active.shown_mm;
  return {{"line", written.line},
          {"work", guard.active.name},
          {"offset_mm", {shown.x(), shown.y(), shown.z()}},
          {"window_mm", guard.window_mm},
          {"tool", guard.tool > 0 ? Json(guard.tool) : Json(nullptr)},
          {"tool_length_mm", guard.length_mm ? Json(*guard.length_mm) : Json(nullptr)},
          {"places", written.places}};
}

Json free_spin_json(const FreeSpin& spin) {
  return {{"programmed_mm", number(spin.programmed_mm, digits)},
          {"programmed_line", spin.programmed_line},
          {"turned_mm", number(spin.turned_mm, digits)},
          {"turned_line", spin.turned_line},
          {"targets", spin.targets},
          {"turned", spin.turned},
          {"least_deg", number(spin.least_deg, 1)},
          {"most_deg", number(spin.most_deg, 1)}};
}

}  // namespace

std::string failed_json(Command command, std::string_view version, const InputError& error, int exit_status) {
  const Location& where = error.where();
  return dump({{"schema", report_schema},
               {"tool", fmt::format("counterflex {}", version)},
               {"command", name_of(command)},
               {"verdict", to_string(Verdict::failed)},
               {"verdict_reason", ""},
               {"failure",
                {{"exit", exit_status},
                 {"kind", name_of(error.kind())},
                 {"file", where.file},
                 {"line", where.line},
                 {"what", error.what()}}}});
}

std::string to_json(const RunReport& report) {
  const std::string& output = report.facts.output;
  Json document = {{"schema", report_schema},
                   {"tool", fmt::format("counterflex {}", report.facts.version)},
                   {"command", name_of(report.command)},
                   {"verdict", to_string(report.verdict)},
                   {"verdict_reason", report.verdict_reason},
                   {"machine", report.machine},
                   {"inputs", inputs_json(report.facts.inputs)},
                   {"output", output.empty() ? Json(nullptr) : Json(output)},
                   {"options", options_json(report.facts.options)},
                   {"failure", failure_json(report)},
                   {"summary", summary_json(report)},
                   {"feed_moves", feed_moves_json(report)},
                   {"forces", forces_json(report)},
                   {"loads", largest_loads_json(report.loads)},
                   {"blocks", blocks_json(report)},
                   {"text", text_json(report)},
                   {"control", control_json(report.control)},
                   {"assumptions", assumptions_json(report)},
                   {"sanity", sanity_json(report.sanity)},
                   {"warning_count", report.warnings.count},
                   {"warnings", warnings_json(report.warnings.rows)},
                   {"worst", worst_json(report)},
                   {"operations", operations_json(report.operations)},
                   {"units", units_json(report.units)}};
  if (report.facts.guard) document["guard"] = guard_json(*report.facts.guard);
  if (report.facts.proof) document["proof"] = proof_json(*report.facts.proof);
  if (report.facts.free_spin) document["free_spin"] = free_spin_json(*report.facts.free_spin);
  if (report.as_programmed) document["only_significant"] = as_programmed_json(*report.as_programmed);
  if (!report.tools.empty()) document["tools"] = tools_json(report.tools);
  if (report.best_offsets) document["offsets"] = best_offsets_json(*report.best_offsets);
  if (report.reversals) document["reversals"] = reversals_json(*report.reversals);
  if (report.uncertainty) document["uncertainty"] = uncertainty_json(*report.uncertainty);
  return dump(document);
}

}  // namespace counterflex
