#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/coupon.hpp"
#include "process/standard_output.hpp"
#include "run/command_outputs.hpp"
#include "run/cut_coupon.hpp"
#include "run/run_checks.hpp"
#include "run/run_end.hpp"
#include "run/run_files.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

constexpr double cmm_sigma = 3 * um;  // of a measured value, where a user writes no other one
// Cautious values for an end mill in steel or aluminium.
constexpr double cutting_speed_m_min = 60, teeth = 2, feed_per_tooth = 0.005;  // of the diameter

[[noreturn]] void refuse_testcut(const std::string& what) {
  throw InputError(ErrorKind::usage, {}, what);
}

void take_box(const std::string& text, CouponRequest& request) {
  const std::vector<double> v = numbers_of("--box", text);
  if (v.size() != 6) refuse_testcut(fmt::format("--box: '{}' has {} numbers, must be 6", text, v.size()));
  request.least_mm = Vector3(v[0], v[1], v[2]);
  request.most_mm = Vector3(v[3], v[4], v[5]);
  if (!(request.least_mm.array() < request.most_mm.array()).all())
    refuse_testcut(fmt::format("--box: '{}': X0, Y0, Z0 must be below X1, Y1, Z1", text));
}

double diameter_of(const TestcutOptions& given, const Machine& machine, long tool) {
  if (given.diameter) return number_of("--diameter-mm", *given.diameter, {0, true});
  const auto found = machine.tools.find(tool);
  if (found != machine.tools.end() && found->second.diameter) return *found->second.diameter / mm;
  refuse_testcut(
      fmt::format("the diameter of tool T{} is not known; give --diameter-mm, or diameter_mm in "
                  "[tools.T{}] of the machine file",
                  tool, tool));
}

CouponRequest request_of(const Options& options, const Machine& machine) {
  const TestcutOptions& given = options.testcut;
  CouponRequest request;
  take_box(*given.box, request);
  const std::optional<long> tool = read_tool_number(*given.tool);
  if (!tool || *tool < 1)
    refuse_testcut(fmt::format("--tool is '{}', must be T and its number, as T3", *given.tool));
  request.tool = *tool;
  request.diameter_mm = diameter_of(given, machine, *tool);
  request.speed_rpm = given.speed ? number_of("--speed-rpm", *given.speed, {1})
                                  : std::round(cutting_speed_m_min * 1e3 / (pi * request.diameter_mm));
  request.feed_mm_min = given.feed ? number_of("--feed-mm-min", *given.feed, {1})
                                   : feed_per_tooth * request.diameter_mm * teeth * request.speed_rpm;
  return request;
}

/// The rows whose prediction is farthest from nominal, in their bands.
std::string largest_rows(const Coupon& coupon, const std::vector<CouponPrediction>& predictions) {
  constexpr std::size_t most = 3;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < coupon.quantities.size(); ++k) order.push_back(k);
  const auto size = [&](std::size_t k) { return std::abs(predictions[k].deviation); };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return size(a) > size(b); });
  std::string text;
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) {
    const CouponQuantity& quantity = coupon.quantities[order[i]];
    const CouponPrediction& p = predictions[order[i]];
    text +=
        fmt::format("{}{}, {}: {} {:+.1f} um, band {:.1f} um\n", i == 0 ? "predicted    " : "             ",
                    quantity.feature, quantity.is_corrected ? "corrected" : "not corrected", quantity.name,
                    p.deviation / um, 2 * p.sigma / um);
  }
  return text;
}

/// Forces are read once for each preparation of the run.
void refuse_forces_of_stdin(const Options& options) {
  if (std::find(options.forces.begin(), options.forces.end(), "-") != options.forces.end())
    refuse_testcut("--forces is -; testcut reads the forces twice: give the name of a file");
}

/// The run of the coupon. The program that is written begins with a header: diagnostics name its lines, so
/// the run is prepared in silence first, for the length of the header.
std::unique_ptr<Run> prepare_coupon(const Options& options, const MachineInput& machine, const Coupon& coupon,
                                    Console& console) {
  Console silent({.quiet = true});
  const auto first = prepare_run(options, machine, coupon.text, silent);
  refuse_what_cannot_be_compensated(*first);
  prepare_writing(options, *first);
  const int header_lines = static_cast<int>(first->options.write.header.size());
  const std::string& name = first->program.file;
  console.name_lines(name, {name}, {1 - header_lines});
  auto run = prepare_run(options, machine, coupon.text, console);
  prepare_writing(options, *run);
  return run;
}

}  // namespace

std::optional<ErrorKind> run_testcut(const Options& options, Console& console) {
  check_coupon_outputs(options);
  refuse_forces_of_stdin(options);
  console.progress("reading");
  const MachineInput input = read_machine_input(options);
  const Coupon coupon = make_coupon(request_of(options, input.machine));
  Options run_options = options;
  run_options.program = *options.output;
  run_options.dialect = "linuxcnc";
  const auto run = prepare_coupon(run_options, input, coupon, console);
  if (acts_at_platform(run->force_input.source))
    throw InputError(ErrorKind::machine_or_force, {},
                     "the forces act at the platform (at = platform); a coupon needs forces at the tip");
  CutCoupon cut;
  if (const auto failure = cut_coupon(run_options, *run, coupon, console, cut))
    return print_failure(*run, failure, console);
  const Machine& machine = run->machine.machine;
  const Measurements rows = coupon_rows(coupon, cut.places, cut.X_MW);
  const std::vector<CouponPrediction> predictions = predict_coupon(machine, coupon, rows, options.threads);
  if (predictions.empty()) {
    console.error("error: the machine has no equilibrium at a place of the coupon");
    return ErrorKind::not_compensated;
  }
  FileWriter program(*options.output), sheet(*options.testcut.sheet);
  program.write(cut.text);
  sheet.write(coupon_sheet(machine, coupon, rows, predictions, cmm_sigma));
  publish_together({&program, &sheet});
  console.finish_warnings();
  console.note(fmt::format(
      "{}: {} lines, one half corrected and verified within {:.4g} mm\n{}: {} rows to "
      "measure\n{}",
      *options.output, std::count(cut.text.begin(), cut.text.end(), '\n'), run->options.tolerance / mm,
      *options.testcut.sheet, rows.rows.size(), largest_rows(coupon, predictions)));
  return std::nullopt;
}

}  // namespace counterflex::cli
