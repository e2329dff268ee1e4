#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/next_measurements.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/nominal.hpp"
#include "identify/fit/residuals.hpp"

namespace counterflex {
namespace {

constexpr double push_force = 300;          // N
constexpr double inset = 0.1;               // of the travel, at both ends
constexpr double farthest_turn = 60 * deg;  // of a rotary actuator, from home
constexpr double farthest_way = 0.3;        // m: of a linear actuator without travel limits, from home
constexpr std::size_t of_program = 8;       // its places
constexpr std::size_t most_repeats = 200;

/// The least, middle and largest value of each actuator (shown values).
std::vector<std::array<double, 3>> levels_of(const Machine& machine) {
  const std::vector<Actuator> all = actuators(machine);
  const Eigen::VectorXd home = shown_homes(machine);
  std::vector<std::array<double, 3>> levels;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double q = home[static_cast<Eigen::Index>(i)];
    const bool turns = all[i].joint.kind == JointKind::revolute;
    const double far = turns ? farthest_turn : farthest_way;
    double least = all[i].min, most = all[i].max;
    if (turns || !std::isfinite(least)) least = std::max(least, q - far);
    if (turns || !std::isfinite(most)) most = std::min(most, q + far);
    levels.push_back({least + inset * (most - least), (least + most) / 2, most - inset * (most - least)});
  }
  return levels;
}

/// All combinations of three levels for up to three actuators; else each actuator alone, and all combinations
/// of two levels for up to six.
std::vector<Eigen::VectorXd> grid_of(const Machine& machine) {
  const std::vector<std::array<double, 3>> levels = levels_of(machine);
  const std::size_t n = levels.size();
  std::vector<Eigen::VectorXd> grid;
  const auto add_combinations = [&](int base) {
    const auto count = static_cast<std::size_t>(std::pow(base, n));
    for (std::size_t k = 0; k < count; ++k) {
      Eigen::VectorXd q(static_cast<Eigen::Index>(n));
      std::size_t rest = k;
      for (std::size_t i = 0; i < n; ++i) {
        const auto level = rest % static_cast<std::size_t>(base);
        q[static_cast<Eigen::Index>(i)] = levels[i][base == 3 ? level : 2 * level];
        rest /= static_cast<std::size_t>(base);
      }
      grid.push_back(std::move(q));
    }
  };
  if (n <= 3) {
    add_combinations(3);
    return grid;
  }
  const Eigen::VectorXd home = shown_homes(machine);
  grid.push_back(home);
  for (std::size_t i = 0; i < n; ++i)
    for (const double value : {levels[i][0], levels[i][2]}) {
      grid.push_back(home);
      grid.back()[static_cast<Eigen::Index>(i)] = value;
    }
  if (n <= 6) add_combinations(2);
  return grid;
}

/// "X 300, Y 200 mm", "A1 10, A2 -75 deg".
std::string words_of(const Machine& machine, const Eigen::VectorXd& shown) {
  const std::vector<Actuator> all = actuators(machine);
  const std::vector<std::string> names = actuator_names(machine);
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool turns = all[i].joint.kind == JointKind::revolute;
    const bool ends = i + 1 == all.size() || all[i + 1].joint.kind != all[i].joint.kind;
    const double value = shown[static_cast<Eigen::Index>(i)] / (turns ? deg : mm);
    text += fmt::format("{}{} {:g}{}", i == 0 ? "" : ", ", names[i].substr(names[i].find(' ') + 1),
                        std::round(value * 10) / 10 + 0.0, ends ? (turns ? " deg" : " mm") : "");
  }
  return text;
}

/// The mean deviation of the rows of a kind, or the default.
double sigma_of(MeasurementKind kind, const Measurements& given) {
  double sum = 0;
  int count = 0;
  for (const Measurement& row : given.rows)
    if (given.sessions[row.session].kind == kind) {
      sum += row.sigma;
      ++count;
    }
  return count == 0 ? default_sigma(kind) : sum / count;
}

}  // namespace

std::vector<NextMeasurement> candidate_measurements(const Machine& machine, const Measurements& given,
                                                    const std::vector<ProgramPlace>& program) {
  std::vector<Eigen::VectorXd> states;
  for (std::size_t k = 0; k < std::min(of_program, program.size()); ++k)
    states.push_back(program[k * program.size() / std::min(of_program, program.size())].state.shown);
  for (Eigen::VectorXd& q : grid_of(machine)) states.push_back(std::move(q));
  const Model model = prepare(machine);
  std::vector<NextMeasurement> list;
  for (const Eigen::VectorXd& shown : states) {
    const CommandedState state{shown};
    if (nominal_forward(model, model.home, joint_values(model.mechanism.shown, shown)).status !=
        Status::converged)
      continue;
    const std::string at = words_of(machine, shown);
    for (int axis = 0; axis < 3; ++axis) {
      NextMeasurement push;
      push.what = fmt::format("static_push along {} with {:.0f} N at {}", "xyz"[axis], push_force, at);
      push.row.states = {state, state};
      push.row.direction = Vector3::Unit(axis);
      push.row.states[0].F[axis] = push_force;
      push.row.sigma = sigma_of(push.kind, given);
      list.push_back(std::move(push));
    }
    NextMeasurement point;
    point.kind = MeasurementKind::tracker_point;
    point.what = fmt::format("tracker_point at {}", at);
    point.row.states = {state};
    point.row.sigma = sigma_of(point.kind, given);
    list.push_back(std::move(point));
  }
  std::size_t repeats = 0;
  for (const Measurement& row : given.rows) {
    const MeasurementKind kind = given.sessions[row.session].kind;
    if (!unknowns_of(kind).empty() || kind == MeasurementKind::static_push || repeats == most_repeats)
      continue;
    ++repeats;
    list.push_back({kind, fmt::format("{} of {}:{} again", name_of(kind), row.at.file, row.at.line), row, 0});
  }
  return list;
}

}  // namespace counterflex
