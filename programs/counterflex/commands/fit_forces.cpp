#include "commands/fit_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "commands/forces_walk.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/forces/spindle_fit.hpp"
#include "counterflex/geometry/types.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/command_outputs.hpp"
#include "run/output_paths.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view fit_mark = "# Cutting models fitted by counterflex";

/// A cutter and a material, which share their coefficients.
struct FitGroup {
  std::string cutter, material;
  CuttingCoefficients given;
};

/// What the program commands the spindle: tool and S (1/min).
using SpindleCommand = std::pair<long, double>;

/// The cutting model, its groups, and what the spindle does.
struct FitInput {
  std::string model_text;
  std::vector<CutSection> sections;
  std::vector<FitGroup> groups;
  std::vector<std::size_t> group_of;  ///< of each section
  SpindleLog log;
  std::string program;
  std::vector<SpindleMove> moves;
  std::vector<SpindleCommand> commands;  ///< of the moves
};

std::string model_file(const Options& options) {
  if (options.forces.size() != 1 || !options.forces.front().ends_with(".toml") ||
      options.forces.front() == "-")
    throw InputError(ErrorKind::usage, {}, "forces fit needs one cutting model, -f FILE.toml");
  const auto scales = [](const Setting& setting) { return setting.option == "load-scale"; };
  if (std::ranges::any_of(options.sources.flags, scales) ||
      std::ranges::any_of(options.sources.environment, scales))
    throw InputError(ErrorKind::usage, {}, "forces fit has no --load-scale: the log has the whole force");
  return options.forces.front();
}

void check_fit_output(const Options& options) {
  if (!options.output) return;
  if (*options.output == "-" && options.json)
    throw InputError(
        ErrorKind::usage, {},
        "the cutting model and the document of --json cannot both go to standard output; give -o "
        "a file");
  if (*options.output != "-" && !options.output->ends_with(".toml"))
    throw InputError(ErrorKind::usage, {*options.output}, "a cutting model is written to a .toml file");
  check_machine_output(*options.output, {options.program, options.forces.front(), *options.forces_table.log},
                       true);
  if (!options.force_overwrite) refuse_foreign({marked_file(*options.output, fit_mark)});
}

void find_groups(FitInput& input) {
  for (const CutSection& section : input.sections) {
    const auto at = std::find_if(input.groups.begin(), input.groups.end(), [&](const FitGroup& group) {
      return group.cutter == section.cutter && group.material == section.material;
    });
    input.group_of.push_back(static_cast<std::size_t>(at - input.groups.begin()));
    if (at == input.groups.end())
      input.groups.push_back({section.cutter, section.material, section.model.coefficients});
  }
}

/// Adds what the spindle does along a feed move, in parts. The torque of a force from another source is
/// unknown.
void add_feed_move(const MoveForce& force, const ForceSource& source, FitInput& input) {
  using Kind = SpindleMove::Kind;
  SpindleMove move{.line = force.line, .rpm = force.spindle_rpm};
  if (force.feed_m_s > 0) move.seconds = force.length / force.feed_m_s;
  if (force.model == nullptr) {
    move.kind = force.F.isZero(0) && !force.changes ? Kind::air : Kind::unknown;
    return input.moves.push_back(move);
  }
  move.group = input.group_of[static_cast<std::size_t>(force.model - source.rules.data())];
  move.seconds /= static_cast<double>(force.torques.size());
  for (const std::optional<CutTorque>& torque : force.torques) {
    move.kind = torque ? Kind::cut : Kind::unknown;
    move.chip_torque = torque ? torque->chip : 0;
    move.edge_torque = torque ? torque->edge : 0;
    input.moves.push_back(move);
  }
}

void add_window(const ForceSource& source, const Program& window, const Toolpath& path,
                const std::vector<MoveForce>& forces, FitInput& input) {
  std::size_t next = 0;
  for (const Segment& segment : path.segments) {
    const Move& of = window.moves[segment.move];
    if (segment.cutting) {
      while (std::isnan(forces[next].length)) ++next;  // its position is not known
      add_feed_move(forces[next++], source, input);
    } else {
      SpindleMove rapid{.line = segment.line, .kind = SpindleMove::Kind::air, .rpm = of.spindle_rpm};
      if (input.log.rapid_m_s > 0) rapid.seconds = length(segment.wanted) / input.log.rapid_m_s;
      input.moves.push_back(rapid);
    }
    input.commands.resize(input.moves.size(), {of.tool, of.spindle_rpm});
  }
}

/// The speeds of the sections in cuts may differ from S of the program. An air cut has the speed of the cuts
/// with the same tool and S before it and after it. If these differ, its speed is unknown.
void settle_speeds(FitInput& input) {
  using Kind = SpindleMove::Kind;
  std::vector<SpindleMove>& moves = input.moves;
  std::map<SpindleCommand, double> speeds;
  std::vector<std::optional<double>> after(moves.size());
  const auto speed_of = [&](std::size_t i) -> std::optional<double> {
    if (moves[i].kind == Kind::cut) speeds[input.commands[i]] = moves[i].rpm;
    const auto at = speeds.find(input.commands[i]);
    return at == speeds.end() ? std::nullopt : std::optional(at->second);
  };
  for (std::size_t i = moves.size(); i-- > 0;) after[i] = speed_of(i);
  speeds.clear();
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const std::optional<double> before = speed_of(i);
    if (moves[i].kind != Kind::air) continue;
    if (before && after[i] && *before != *after[i]) moves[i].kind = Kind::unknown;
    if (before || after[i]) moves[i].rpm = before ? *before : *after[i];
  }
}

/// A log shows the mean torque over a revolution, wherever the force of a section acts.
void take_mean_torques(const std::vector<CutSection>& sections, ForceSource& source) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    CuttingModel model = sections[i].model;
    model.force_at = ForceAt::mean;
    source.rules[i].content = respond(model);
  }
}

FitInput read_fit_input(const Options& options, Console& console) {
  FitInput input;
  const std::string file = model_file(options);
  input.model_text = read_file(file);
  input.sections = read_cutting_model(input.model_text, file);
  find_groups(input);
  input.log = read_spindle_log(read_file(*options.forces_table.log), *options.forces_table.log);
  walk_forces(
      options, console,
      [&](const std::string& program, ForceSource& source) {
        input.program = program;
        source.scale = 1;  // the log has the whole force
        take_mean_torques(input.sections, source);
      },
      [&](const ForceSource& source, const Program& window, const Toolpath& path,
          const std::vector<MoveForce>& forces) { add_window(source, window, path, forces, input); });
  settle_speeds(input);
  return input;
}

/// The coefficient that is identified, in the unit of its key.
struct ShownCoefficient {
  std::string_view key;
  double given = 0, value = 0, sigma = 0;
};

ShownCoefficient shown_coefficient(const FitGroup& group, const SpindleFit::Value& scale) {
  const bool kienzle = group.given.m_c > 0;
  const double given = (kienzle ? main_value(group.given) : group.given.K_tc) / N_per_mm2;
  return {kienzle ? "kc11_N_mm2" : "Ktc_N_mm2", given, scale.value * given, scale.sigma * given};
}

std::string_view unit_of_channel(SpindleChannel channel) {
  return channel == SpindleChannel::power ? "W" : "N m";
}

/// Throws if a coefficient is found to be 0 or less: at the log, which the cutting model does not explain.
void refuse_negative(const FitInput& input, const SpindleFit& fit) {
  for (std::size_t g = 0; g < input.groups.size(); ++g) {
    if (fit.scales[g].samples == 0 || fit.scales[g].value > 0) continue;
    const FitGroup& group = input.groups[g];
    const ShownCoefficient of = shown_coefficient(group, fit.scales[g]);
    throw InputError(
        ErrorKind::machine_or_force, {input.log.file, input.log.samples.front().row, 1},
        fmt::format(
            "the log gives {} = {:.1f} +- {:.1f} for cutter {} in {}; it must be positive: {} does not "
            "rise with the chip; check sign and column of the channel, and depths, engagement and "
            "edge coefficients of the cutting model",
            of.key, of.value, of.sigma, without_controls(group.cutter), without_controls(group.material),
            input.log.channel == SpindleChannel::power ? "the power" : "the torque"));
  }
}

std::string fit_text(const FitInput& input, const SpindleFit& fit) {
  const std::string_view unit = unit_of_channel(input.log.channel);
  std::string text = fmt::format("spindle {} of {} over {}\n\nsamples    {} used of {}\n",
                                 input.log.channel == SpindleChannel::power ? "power" : "torque",
                                 without_controls(input.log.file), without_controls(input.program),
                                 fit.samples, input.log.samples.size());
  if (!input.log.by_line)
    text += fmt::format("offset     the program begins at {:.3f} s of the log; drift {:.3f} s\n", fit.offset,
                        fit.drift);
  for (const SpindleFit::Idle& idle : fit.idle)
    text += fmt::format("idle       {:.6g} 1/min: {:.4g} +- {:.2g} {}, {} samples\n", idle.rpm,
                        idle.value.value, idle.value.sigma, unit, idle.value.samples);
  text += fmt::format(
      "residual   {:.3g} {} rms, correlation of neighbours {:.2f}\n\n{:<12} {:<20} {:<12} "
      "{:>10} {:>10} {:>8} {:>9}\n",
      fit.residual, unit, fit.correlation, "cutter", "material", "coefficient", "given", "found", "sigma",
      "samples");
  for (std::size_t g = 0; g < input.groups.size(); ++g) {
    const FitGroup& group = input.groups[g];
    const ShownCoefficient of = shown_coefficient(group, fit.scales[g]);
    text += fmt::format("{:<12} {:<20} {:<12} {:>10.1f} ", without_controls(group.cutter),
                        without_controls(group.material), of.key, of.given);
    text += fit.scales[g].samples == 0
                ? std::string("not identified: fewer than 10 samples in its cuts\n")
                : fmt::format("{:>10.1f} {:>8.1f} {:>9}\n", of.value, of.sigma, fit.scales[g].samples);
  }
  return text;
}

std::string fit_json(const FitInput& input, const SpindleFit& fit) {
  nlohmann::ordered_json idle = nlohmann::ordered_json::array(), fits = nlohmann::ordered_json::array();
  const bool power = input.log.channel == SpindleChannel::power;
  for (const SpindleFit::Idle& at : fit.idle)
    idle.push_back({{"spindle_rpm", rounded(at.rpm, 6)},
                    {power ? "power_W" : "torque_Nm", rounded(at.value.value, 9)},
                    {"sigma", rounded(at.value.sigma, 9)},
                    {"samples", at.value.samples}});
  for (std::size_t g = 0; g < input.groups.size(); ++g) {
    const FitGroup& group = input.groups[g];
    const ShownCoefficient of = shown_coefficient(group, fit.scales[g]);
    nlohmann::ordered_json entry{{"cutter", group.cutter},
                                 {"material", group.material},
                                 {"coefficient", of.key},
                                 {"given", rounded(of.given, 6)},
                                 {"samples", fit.scales[g].samples}};
    const bool identified = fit.scales[g].samples > 0;
    entry["value"] = identified ? nlohmann::ordered_json(rounded(of.value, 6)) : nullptr;
    entry["sigma"] = identified ? nlohmann::ordered_json(rounded(of.sigma, 6)) : nullptr;
    fits.push_back(std::move(entry));
  }
  nlohmann::ordered_json json{{"schema", "counterflex-force-fit 1"},
                              {"program", input.program},
                              {"log", input.log.file},
                              {"channel", power ? "power" : "torque"},
                              {"samples", input.log.samples.size()},
                              {"used_samples", fit.samples}};
  if (!input.log.by_line) {
    json["offset_s"] = rounded(fit.offset, 6);
    json["drift_s"] = rounded(fit.drift, 6);
  }
  json["residual_rms"] = rounded(fit.residual, 9);
  json["neighbour_correlation"] = rounded(fit.correlation, 6);
  json["idle"] = std::move(idle);
  json["coefficients"] = std::move(fits);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string_view without_fit_mark(std::string_view text) {
  if (!text.starts_with(fit_mark)) return text;
  const std::size_t end = text.find('\n');
  return end == std::string_view::npos ? "" : text.substr(end + 1);
}

std::string fitted_text(const FitInput& input, const SpindleFit& fit, const std::string& file) {
  const std::string log = without_controls(std::filesystem::path(input.log.file).filename().generic_string());
  std::vector<FittedMaterial> fitted;
  for (std::size_t g = 0; g < input.groups.size(); ++g) {
    if (fit.scales[g].samples == 0) continue;
    const FitGroup& group = input.groups[g];
    const ShownCoefficient of = shown_coefficient(group, fit.scales[g]);
    CuttingCoefficients K = group.given;
    for (double* chip : {&K.K_tc, &K.K_rc, &K.K_ac}) *chip *= fit.scales[g].value;
    fitted.push_back({group.cutter, group.material, K,
                      fmt::format("{} = {:.1f} +- {:.1f} (1 sigma), {} samples of {}; {:.1f} was given",
                                  of.key, of.value, of.sigma, fit.scales[g].samples, log, of.given)});
  }
  return fmt::format("{} {} from {}\n", fit_mark, version, log) +
         with_fitted_materials(without_fit_mark(input.model_text), file, fitted);
}

}  // namespace

std::optional<ErrorKind> fit_forces(const Options& options, Console& console) {
  const std::string file = model_file(options);
  check_fit_output(options);
  const FitInput input = read_fit_input(options, console);
  const SpindleFit fit = fit_spindle(input.log, input.moves, input.groups.size());
  refuse_negative(input, fit);
  const std::string fitted = fitted_text(input, fit, file);
  std::optional<FileWriter> output;
  if (options.output) {
    output.emplace(*options.output);
    output->write(fitted);
  }
  check_fit_output(options);  // again: a foreign file may have appeared
  publish_together({if_any(output)});
  console.finish_warnings();
  const std::string table = fit_text(input, fit);
  if (options.output == "-") {
    console.note(table);
    return std::nullopt;
  }
  const std::string written =
      options.output ? fmt::format("\nwritten    {}\n", without_controls(*options.output)) : "";
  write_result(options.json ? fit_json(input, fit) : table + written);
  return std::nullopt;
}

}  // namespace counterflex::cli
