#include "facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "counterflex/geometry/units.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

std::string text_of(const Vector6& F) {
  return fmt::format("{},{},{},{},{},{}", F[0], F[1], F[2], F[3], F[4], F[5]);
}

/// Of --force: "T3=1,2,3,0,0,0".
std::string text_of(const ForceRule& rule) {
  const std::string tool = rule.selector.tool ? fmt::format("T{}=", *rule.selector.tool) : "";
  return tool + text_of(std::get<ConstantForce>(rule.content).F);
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string short_hash(const InputFile& file) {
  return upper(file.sha256.substr(0, 16));
}

/// Millimetres of what was given in millimetres: 0.005, not 0.0049999999.
double in_mm(double length) {
  return std::round(length / mm * 1e12) / 1e12;
}

std::vector<OptionValue> reading_options(const Options& options, const Run& run) {
  std::vector<OptionValue> values{{"dialect", run.program.dialect}};
  if (options.units)
    values.push_back({"units", std::string(*options.units == LengthUnit::millimetres ? "mm" : "inch")});
  if (options.integer_words != IntegerWords::unsaid)
    values.push_back({"integer-words",
                      std::string(options.integer_words == IntegerWords::units ? "units" : "increments")});
  if (options.expand_subprograms) values.push_back({"expand-subprograms", true});
  for (const std::string& work : options.work) values.push_back({"work", work});
  for (const auto& [number, length_mm] : options.tool_lengths_mm)
    values.push_back({"tool-length", fmt::format("T{}={}", number, length_mm)});
  return values;
}

}  // namespace

RunFacts facts_of(const Options& options, const Run& run) {
  RunFacts facts;
  facts.version = version;
  // It takes several times as long as all else of `compensate`, which is not the command that asks for it.
  facts.attribution =
      options.command != Command::compensate || options.json || options.report || options.plot;
  facts.inputs = {run.file.file, run.machine.file};
  const auto& forces = run.force_input.files;
  facts.inputs.insert(facts.inputs.end(), forces.begin(), forces.end());
  if (run.tools.file) facts.inputs.push_back(*run.tools.file);
  facts.min_block_ms = options.min_block_ms;
  facts.accept_partial = options.accept_partial;
  facts.options = {{"method", std::string(to_string(options.method))},
                   {"tolerance-mm", in_mm(run.options.tolerance)},
                   {"max-correction-mm", in_mm(run.options.max_correction)},
                   {"load-scale", options.load_scale},
                   {"blend-mm", in_mm(options.blend)}};
  for (const ForceRule& rule : options.force_rules) facts.options.push_back({"force", text_of(rule)});
  if (options.air_above_mm) facts.options.push_back({"air-above", *options.air_above_mm});
  if (options.accept_partial) facts.options.push_back({"accept-partial", true});
  if (options.decimals >= 0) facts.options.push_back({"decimals", static_cast<double>(options.decimals)});
  for (OptionValue& value : reading_options(options, run)) facts.options.push_back(std::move(value));
  return facts;
}

std::vector<std::string> header_of(const Options& options, const Run& run) {
  std::vector<std::string> lines{fmt::format("COUNTERFLEX 1 VERSION {} METHOD {}", upper(version),
                                             upper(std::string(to_string(run.options.method)))),
                                 "COUNTERFLEX 1 PROGRAM " + short_hash(run.file.file),
                                 "COUNTERFLEX 1 MACHINE " + short_hash(run.machine.file)};
  for (const InputFile& forces : run.force_input.files)
    lines.push_back("COUNTERFLEX 1 FORCES " + short_hash(forces));
  if (run.tools.file) lines.push_back("COUNTERFLEX 1 TOOLS " + short_hash(*run.tools.file));
  for (const ForceRule& rule : options.force_rules)
    lines.push_back("COUNTERFLEX 1 FORCE " + upper(text_of(rule)));
  return lines;
}

}  // namespace counterflex::cli
