#include "run/facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"
#include "process/version.hpp"
#include "run/header/header.hpp"
#include "run/proof.hpp"

namespace counterflex::cli {
namespace {

/// Converts to mm without rounding noise: 0.005, not 0.0049999999.
double in_mm(double length) {
  return std::round(length / mm * 1e12) / 1e12;
}

std::vector<OptionValue> reading_options(const Options& options, const Run& run) {
  std::vector<OptionValue> values{{"dialect", run.program.dialect}};
  if (options.units)
    values.push_back({"units", std::string(*options.units == LengthUnit::millimetres ? "mm" : "inch")});
  if (options.integer_words != IntegerWords::unspecified)
    values.push_back({"integer-words",
                      std::string(options.integer_words == IntegerWords::units ? "units" : "increments")});
  if (options.absolute_centres)
    values.push_back({"arc-centres", std::string(*options.absolute_centres ? "absolute" : "incremental")});
  if (options.evaluate) values.push_back({"evaluate", true});
  if (options.expand_subprograms) values.push_back({"expand-subprograms", true});
  for (const std::string& work : options.work) values.push_back({"work", work});
  if (options.samples > 0) values.push_back({"samples", static_cast<double>(options.samples)});
  if (options.temperature) values.push_back({"temperature-C", *options.temperature});
  for (const auto& [number, length_mm] : options.tool_lengths_mm)
    values.push_back({"tool-length", fmt::format("T{}={}", number, length_mm)});
  return values;
}

}  // namespace

RunFacts facts_of(const Options& options, const Run& run) {
  RunFacts facts;
  facts.version = version;
  // Causes along the path take about as long as everything else in `compensate`; only the other commands
  // compute them always.
  facts.attribution = !options.without_causes && (options.command != Command::compensate || options.json ||
                                                  options.report || options.plot);
  facts.inputs = {run.file.file, run.machine.file};
  const auto& forces = run.force_input.files;
  const auto& lists = run.file.data_lists;
  facts.inputs.insert(facts.inputs.end(), lists.begin(), lists.end());
  facts.inputs.insert(facts.inputs.end(), forces.begin(), forces.end());
  facts.inputs.insert(facts.inputs.end(), run.uncertainty_files.begin(), run.uncertainty_files.end());
  if (run.tools.file) facts.inputs.push_back(*run.tools.file);
  if (wants_proof(options) && !options.project_file.empty()) {
    FileReader project(options.project_file);
    facts.inputs.push_back({"project", options.project_file, sha256(project)});
  }
  facts.min_block_ms = options.min_block_ms;
  facts.accept_partial = options.accept_partial;
  facts.options = {{"method", std::string(to_string(options.method))},
                   {"tolerance-mm", in_mm(run.options.tolerance)},
                   {"max-correction-mm", in_mm(run.options.max_correction)},
                   {"load-scale", options.load_scale},
                   {"blend-mm", in_mm(options.blend)}};
  if (run.program.turns_tool) {
    facts.options.push_back({"tolerance-tilt-deg", run.options.tilt_tolerance / deg});
    if (const auto& spin = run.options.spin_tolerance)
      facts.options.push_back({"tolerance-spin-deg", *spin / deg});
  }
  if (options.only_significant) facts.options.push_back({"only-significant", true});
  if (options.free_spin) facts.options.push_back({"free", std::string("spin")});
  for (const ForceRule& rule : options.force_rules) facts.options.push_back({"force", force_rule_text(rule)});
  if (options.number_pieces) facts.options.push_back({"number-pieces", true});
  if (options.max_points) facts.options.push_back({"max-points", static_cast<double>(*options.max_points)});
  if (options.guard) facts.options.push_back({"guard", true});
  if (wants_proof(options)) facts.options.push_back({"proof", true});
  if (options.air_above_mm) facts.options.push_back({"air-above", *options.air_above_mm});
  if (options.predict.offsets) facts.options.push_back({"offsets", true});
  if (options.accept_partial) facts.options.push_back({"accept-partial", true});
  if (options.decimals >= 0) facts.options.push_back({"decimals", static_cast<double>(options.decimals)});
  for (OptionValue& value : reading_options(options, run)) facts.options.push_back(std::move(value));
  return facts;
}

}  // namespace counterflex::cli
