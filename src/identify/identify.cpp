#include "counterflex/identify/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameter_places.hpp"
#include "identify/fit/fit.hpp"
#include "identify/fit/frames.hpp"
#include "identify/hold_out.hpp"
#include "identify/prior.hpp"

namespace counterflex {
namespace {

constexpr double least_share = 1e-3;  // of a compliance or mass: the lower bound of the fit
constexpr double identified = 0.5;    // of the prior deviation: larger ones are not identified
constexpr double strong_correlation = 0.9;
constexpr double most_spread = 5;  // ratio of measured to commanded motion that a probe's lever explains
constexpr std::size_t most_outliers = 50, most_worst = 10;

bool is_geometry(ParameterKind kind) {
  return kind == ParameterKind::position || kind == ParameterKind::orientation;
}

/// By parameter: whether it moves the zero of the actuator just before its error slot.
std::vector<bool> zeros_of(const Machine& machine) {
  Machine copy = machine;
  std::map<const Element*, const Actuator*> before;
  const auto visit = [&](const auto& self, const std::vector<Element>& elements) -> void {
    const Actuator* last = nullptr;
    for (const Element& element : elements) {
      if (std::holds_alternative<AssemblyError>(element)) before[&element] = last;
      if (const auto* actuator = std::get_if<Actuator>(&element))
        last = actuator;
      else if (!std::holds_alternative<Compliance>(element) && !std::holds_alternative<PointMass>(element))
        last = nullptr;
      if (const auto* group = std::get_if<Group>(&element))
        for (const Branch& branch : group->branches) self(self, branch.elements);
    }
  };
  for (const Chain& chain : copy.chains) visit(visit, chain.elements);
  std::vector<bool> zeros;
  for (const ParameterPlace& place : parameter_places(copy)) {
    const auto found = before.find(place.element);
    const Actuator* actuator = found == before.end() ? nullptr : found->second;
    const bool turns = actuator != nullptr && actuator->joint.kind == JointKind::revolute;
    zeros.push_back(actuator != nullptr && turns == (place.kind == ParameterKind::orientation) &&
                    std::abs(actuator->joint.axis[place.component % 3]) > 0.999);
  }
  return zeros;
}

/// Geometry has the zeros, too.
bool is_in(ParameterSet set, const std::vector<ParameterSet>& sets) {
  return std::any_of(sets.begin(), sets.end(), [&](ParameterSet s) {
    return s == set || (s == ParameterSet::geometry && set == ParameterSet::zeros);
  });
}

struct Candidates {
  std::vector<std::size_t> varied;
  std::vector<ParameterSet> set;  ///< by varied parameter: the first that has it
  std::vector<bool> is_default;
  Eigen::VectorXd before, prior, least;
};

ParameterSet set_of(const Parameter& parameter, bool is_zero) {
  if (parameter.kind == ParameterKind::compliance) return ParameterSet::compliance;
  if (parameter.kind == ParameterKind::mass) return ParameterSet::mass;
  if (parameter.kind == ParameterKind::reversal) return ParameterSet::reversal;
  return is_zero ? ParameterSet::zeros : ParameterSet::geometry;
}

bool has_directions(const Measurements& measurements) {
  for (const Measurement& row : measurements.rows)
    for (const CommandedState& state : row.states)
      if (state.directions != Directions{}) return true;
  return false;
}

Candidates candidates(const Machine& machine, const Measurements& measurements,
                      const std::vector<ParameterSet>& sets) {
  Candidates result;
  const std::vector<Parameter> all = parameters(machine);
  const std::vector<bool> zeros = zeros_of(machine);
  std::vector<double> before, prior, least;
  const bool shows_reversal = has_directions(measurements);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].kind == ParameterKind::reversal && !shows_reversal) continue;
    const ParameterSet set = set_of(all[i], zeros[i]);
    if (!is_in(set, sets)) continue;
    const PriorDeviation known = prior_deviation(machine, all[i]);
    if (!known.is_default && known.sigma == 0) continue;
    result.varied.push_back(i);
    result.set.push_back(set);
    result.is_default.push_back(known.is_default);
    before.push_back(all[i].value);
    prior.push_back(known.sigma);
    least.push_back(is_geometry(all[i].kind)                 ? -std::numeric_limits<double>::infinity()
                    : all[i].kind == ParameterKind::reversal ? 0
                                                             : least_share * all[i].value);
  }
  const auto n = static_cast<Eigen::Index>(before.size());
  result.before = Eigen::Map<Eigen::VectorXd>(before.data(), n);
  result.prior = Eigen::Map<Eigen::VectorXd>(prior.data(), n);
  result.least = Eigen::Map<Eigen::VectorXd>(least.data(), n);
  return result;
}

/// Throws where a session has fewer numbers than its frames have freedoms, or states that are all alike.
void check_sessions(const Measurements& measurements) {
  if (measurements.rows.empty())
    throw InputError(ErrorKind::machine_or_force, {}, "there are no measurements");
  for (std::size_t s = 0; s < measurements.sessions.size(); ++s) {
    const Session& session = measurements.sessions[s];
    std::size_t numbers = 0;
    double spread = 0;
    const Measurement* first = nullptr;
    for (const Measurement& row : measurements.rows) {
      if (row.session != s) continue;
      numbers += session.kind == MeasurementKind::tracker_pose    ? 6
                 : session.kind == MeasurementKind::tracker_point ? 3
                                                                  : 1;
      if (first == nullptr) first = &row;
      spread = std::max(spread, (row.states[0].shown - first->states[0].shown).cwiseAbs().maxCoeff());
    }
    const std::size_t unknowns = unknowns_of(session.kind).size();
    if (first == nullptr) continue;
    if (numbers <= unknowns)
      throw InputError(
          ErrorKind::machine_or_force, first->at,
          fmt::format("session \"{}\" has {} measured numbers; its frames alone have {} freedoms: measure "
                      "more states",
                      session.name, numbers, unknowns));
    const bool needs_motion = unknowns > 0;
    if (needs_motion && spread < 1e-6)
      throw InputError(ErrorKind::machine_or_force, first->at,
                       fmt::format("all rows of session \"{}\" have the same actuator values; no fit can "
                                   "separate its frames from the machine's parameters: measure other states",
                                   session.name));
  }
}

/// Rms scatter of positions and readings at states that a session has more than once (m).
std::optional<double> repeatability_of(const Measurements& measurements) {
  double squares = 0;
  int freedoms = 0;
  std::map<std::pair<std::size_t, std::vector<long>>, std::vector<const Measurement*>> same;
  for (const Measurement& row : measurements.rows) {
    std::vector<long> state;
    for (const CommandedState& at : row.states) {
      state.push_back(static_cast<long>(at.directions.forward));
      state.push_back(static_cast<long>(at.directions.backward));
      for (const double value : at.shown) state.push_back(std::lround(value * 1e6));
      for (const double value : at.F) state.push_back(std::lround(value * 1e3));
    }
    for (const double value : row.direction) state.push_back(std::lround(value * 1e4));
    same[{row.session, state}].push_back(&row);
  }
  for (const auto& [key, rows] : same) {
    const bool is_feature = measurements.sessions[key.first].kind == MeasurementKind::cmm_feature;
    if (rows.size() < 2 || !rows[0]->is_length || is_feature) continue;
    Vector3 mean = Vector3::Zero();
    double value = 0;
    for (const Measurement* row : rows) {
      mean += row->X.p / static_cast<double>(rows.size());
      value += row->value / static_cast<double>(rows.size());
    }
    for (const Measurement* row : rows)
      squares += (row->X.p - mean).squaredNorm() + (row->value - value) * (row->value - value);
    freedoms += static_cast<int>(rows.size()) - 1;
  }
  if (freedoms < 3) return {};
  return std::sqrt(squares / freedoms);
}

/// Median distance from the median place (m).
double spread_of(const std::vector<Vector3>& places) {
  const auto median = [](std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  Vector3 centre;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Vector3& p : places) values.push_back(p[k]);
    centre[k] = median(values);
  }
  std::vector<double> distances;
  for (const Vector3& p : places) distances.push_back((p - centre).norm());
  return median(distances);
}

/// Throws where measured places spread far more, or less, than the tips at the commanded states: a unit is
/// wrong.
void check_units(const Session& session, const std::vector<const Measurement*>& rows,
                 const std::vector<Pose>& X_MT) {
  const bool is_tracker =
      session.kind == MeasurementKind::tracker_point || session.kind == MeasurementKind::tracker_pose;
  if (!is_tracker || rows.size() < 5) return;
  std::vector<Vector3> measured, tips;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measured.push_back(rows[i]->X.p);
    tips.push_back(X_MT[i].p);
  }
  const double spread = spread_of(measured), moved = spread_of(tips);
  if (spread < most_spread * moved && moved < most_spread * spread) return;
  throw InputError(
      ErrorKind::machine_or_force, rows[0]->at,
      fmt::format(
          "session \"{}\": the measured positions spread {:.3g} mm about their middle, the tip at the "
          "actuator values {:.3g} mm; check the units of x, y, z and of the actuators (mm or inch, deg "
          "or rad)",
          session.name, spread / mm, moved / mm));
}

std::vector<SessionFrames> first_frames(const FitProblem& problem, const std::vector<Response>& found) {
  std::vector<SessionFrames> frames;
  for (std::size_t s = 0; s < problem.measurements.sessions.size(); ++s) {
    std::vector<const Measurement*> rows;
    std::vector<Pose> X_MT;
    for (std::size_t i = 0; i < problem.measurements.rows.size(); ++i) {
      const Measurement& row = problem.measurements.rows[i];
      const Response& at = found[problem.states.first[i]];
      if (row.session != s || at.status != Status::converged) continue;
      rows.push_back(&row);
      X_MT.push_back(at.X_MT);
    }
    if (!rows.empty()) check_units(problem.measurements.sessions[s], rows, X_MT);
    frames.push_back(rows.empty() ? SessionFrames{}
                                  : first_frames(problem.measurements.sessions[s], rows, X_MT));
  }
  return frames;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// Tries sets of parameters on rows that the fits do not see.
class Ladder {
 public:
  Ladder(const FitProblem& problem, const Candidates& candidates, const Fit& all,
         std::vector<RowGroup> groups)
      : problem_(problem), candidates_(candidates), all_(all), groups_(std::move(groups)) {}

  /// Prior deviations of the parameters whose sets are in `sets`, 0 for the others.
  Eigen::VectorXd prior_of(const std::vector<ParameterSet>& sets) const {
    Eigen::VectorXd prior = candidates_.prior;
    for (Eigen::Index k = 0; k < prior.size(); ++k)
      if (!is_in(candidates_.set[static_cast<std::size_t>(k)], sets)) prior[k] = 0;
    return prior;
  }

  bool has(ParameterSet set) const {
    return std::find(candidates_.set.begin(), candidates_.set.end(), set) != candidates_.set.end();
  }

  /// The step from where `all` is linearised for a fit with these sets to the rows outside of a group.
  FitStep trained(const std::vector<ParameterSet>& sets, const RowGroup& group) const {
    std::vector<bool> is_held(all_.rows.size(), false);
    for (const std::size_t row : group.rows) is_held[row] = true;
    const Eigen::VectorXd prior = prior_of(sets);
    // Other parameters have their values in the file, not those of `all`.
    Eigen::VectorXd back = Eigen::VectorXd::Zero(prior.size());
    for (Eigen::Index k = 0; k < prior.size(); ++k)
      if (prior[k] == 0) back[k] = problem_.before[k] - all_.values[k];
    std::vector<LinearRow> rows = all_.rows;
    for (LinearRow& row : rows)
      if (row.at.is_found) row.at.r += row.at.J_p * back;
    FitStep step = refit(problem_, rows, all_.values, prior, [&](std::size_t i) { return !is_held[i]; });
    step.parameters += back;
    return step;
  }

  std::vector<RowErrors> errors(const std::vector<ParameterSet>& sets) const {
    std::vector<RowErrors> result;
    for (const RowGroup& group : groups_)
      result.push_back(errors_of(problem_, group, all_.rows, trained(sets, group)));
    return result;
  }

  const std::vector<RowGroup>& groups() const { return groups_; }

 private:
  const FitProblem& problem_;
  const Candidates& candidates_;
  const Fit& all_;
  std::vector<RowGroup> groups_;
};

/// Mean error of each group in units of the rows' deviations, so that gauges and trackers count alike.
std::vector<double> relative_means(const Measurements& measurements, const std::vector<RowErrors>& errors) {
  std::vector<double> means;
  for (const RowErrors& group : errors) {
    double sum = 0;
    for (std::size_t k = 0; k < group.rows.size(); ++k)
      sum += group.distance[k] / measurements.rows[group.rows[k]].sigma;
    means.push_back(group.rows.empty() ? 0 : sum / static_cast<double>(group.rows.size()));
  }
  return means;
}

double mean_error(const std::vector<RowErrors>& errors) {
  std::vector<double> means;
  for (const RowErrors& group : errors) means.push_back(mean_of(group.distance));
  return mean_of(means);
}

std::vector<ParameterSet> climb(const Ladder& ladder, const Measurements& measurements,
                                const std::vector<ParameterSet>& sets, std::vector<LadderStep>& steps) {
  std::vector<ParameterSet> kept;
  std::vector<RowErrors> now = ladder.errors(kept);
  for (const ParameterSet set : sets) {
    if (!ladder.has(set)) continue;
    std::vector<ParameterSet> with = kept;
    with.push_back(set);
    const std::vector<RowErrors> next = ladder.errors(with);
    const std::vector<double> before = relative_means(measurements, now),
                              after = relative_means(measurements, next);
    std::vector<double> gains;
    for (std::size_t g = 0; g < before.size(); ++g)
      gains.push_back(before[g] > 0 ? (before[g] - after[g]) / before[g] : 0);
    const double gain = mean_of(gains);
    double squares = 0;
    for (const double g : gains) squares += (g - gain) * (g - gain);
    const auto count = static_cast<double>(gains.size());
    LadderStep step{set,  mean_error(now), mean_error(next), gain, std::sqrt(squares / (count * (count - 1))),
                    false};
    step.is_kept = gain > step.gain_scatter;
    if (step.is_kept) {
      kept = with;
      now = next;
    }
    steps.push_back(step);
  }
  return kept;
}

void add_held_out(const Ladder& ladder, const FitProblem& problem, const std::vector<ParameterSet>& kept,
                  std::vector<HeldOutGroup>& list) {
  const std::vector<RowErrors> before = ladder.errors({}), after = ladder.errors(kept);
  for (std::size_t g = 0; g < before.size(); ++g) {
    std::map<std::pair<MeasurementKind, bool>, std::array<std::vector<double>, 4>> kinds;
    const auto add = [&](const RowErrors& errors, std::size_t at) {
      std::size_t angle = 0;
      for (std::size_t k = 0; k < errors.rows.size(); ++k) {
        const Measurement& row = problem.measurements.rows[errors.rows[k]];
        const MeasurementKind kind = problem.measurements.sessions[row.session].kind;
        auto& lists = kinds[{kind, row.is_length}];
        lists[at].push_back(errors.distance[k]);
        if (kind == MeasurementKind::tracker_pose) lists[at + 2].push_back(errors.angle[angle++]);
      }
    };
    add(before[g], 0);
    add(after[g], 1);
    for (auto& [kind, all] : kinds)
      list.push_back({ladder.groups()[g].name, kind.first, kind.second, summary(all[0]), summary(all[1]),
                      summary(all[2]), summary(all[3])});
  }
}

/// Where fits without one group each differ by more than the covariance explains, the misfit is not noise.
/// The deviation is then that of the delete-a-group jackknife. Source: Efron, Tibshirani, "An Introduction to
/// the Bootstrap" (1993), chapter 11.
void widen_by_groups(const Ladder& ladder, const std::vector<ParameterSet>& kept,
                     Eigen::MatrixXd& covariance) {
  const auto groups = static_cast<double>(ladder.groups().size());
  if (groups < 2) return;
  std::vector<Eigen::VectorXd> values;
  for (const RowGroup& group : ladder.groups()) values.push_back(ladder.trained(kept, group).parameters);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(values[0].size());
  for (const Eigen::VectorXd& v : values) mean += v / groups;
  // The 99 % quantile of chi^2 over its freedoms, by Wilson and Hilferty.
  const double f = groups - 1, chance = std::pow(1 - 2 / (9 * f) + 2.326 * std::sqrt(2 / (9 * f)), 3);
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    double squares = 0;
    for (const Eigen::VectorXd& v : values) squares += (v[k] - mean[k]) * (v[k] - mean[k]);
    const double jackknife = (groups - 1) / groups * squares;
    if (!(jackknife > chance * covariance(k, k)) || !(covariance(k, k) > 0)) continue;
    const double factor = std::sqrt(jackknife / covariance(k, k));
    covariance.row(k) *= factor;
    covariance.col(k) *= factor;
  }
}

void fill_parameters(const Machine& machine, const Candidates& candidates, const Fit& fit,
                     const Eigen::VectorXd& prior, Identification& result) {
  const std::vector<Parameter> all = parameters(machine);
  std::vector<double> values;
  for (const Parameter& parameter : all) values.push_back(parameter.value);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < prior.size(); ++k) {
    if (prior[k] == 0) continue;
    kept.push_back(k);
    const std::size_t index = candidates.varied[static_cast<std::size_t>(k)];
    const double sigma = std::min(std::sqrt(result.covariance(k, k)), prior[k]);
    result.parameters.push_back(
        {all[index].name, all[index].kind, all[index].unit, all[index].value, fit.values[k], prior[k], sigma,
         candidates.is_default[static_cast<std::size_t>(k)], sigma < identified * prior[k]});
    values[index] = fit.values[k];
  }
  result.machine = with_parameters(machine, values);
  result.covariance = Eigen::MatrixXd(result.covariance(kept, kept));
  for (std::size_t i = 0; i < result.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double value =
          result.covariance(a, b) / std::sqrt(result.covariance(a, a) * result.covariance(b, b));
      if (std::abs(value) > strong_correlation && result.parameters[i].is_identified &&
          result.parameters[j].is_identified)
        result.correlations.push_back({result.parameters[j].name, result.parameters[i].name, value});
    }
}

void fill_rows(const FitProblem& problem, const Fit& fit, Identification& result) {
  std::vector<std::pair<double, std::size_t>> ratios;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < fit.rows.size(); ++i) {
    const LinearRow& row = fit.rows[i];
    const Measurement& measured = problem.measurements.rows[i];
    const double error = row.at.is_found ? row.at.r.head(row.at.distances).norm() * measured.sigma : 0;
    ratios.emplace_back(ratio(row), i);
    if (row.weight == 0 || !row.at.is_found)
      result.outliers.push_back(
          {measured.at, problem.measurements.sessions[row.session].name, error, ratio(row)});
    else if (measured.is_length) {
      squares += error * error;
      ++count;
    }
  }
  if (count > 0) result.lack_of_fit = std::sqrt(squares / static_cast<double>(count));
  std::stable_sort(ratios.begin(), ratios.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [size, i] : ratios)
    if (fit.rows[i].weight > 0 && result.worst.size() < most_worst)
      result.worst.push_back(problem.measurements.rows[i].at);
  std::stable_sort(result.outliers.begin(), result.outliers.end(),
                   [](const Outlier& a, const Outlier& b) { return a.ratio > b.ratio; });
  result.outlier_count = result.outliers.size();
  if (result.outliers.size() > most_outliers) result.outliers.resize(most_outliers);
}

}  // namespace

Identification identify(const Machine& machine, const Measurements& measurements,
                        const IdentifyOptions& options) {
  check_sessions(measurements);
  const States states = nominal_states(machine, measurements, options.threads);
  const Candidates candidate = candidates(machine, measurements, options.sets);
  if (candidate.varied.empty())
    throw InputError(ErrorKind::machine_or_force, {},
                     "the machine file has no parameter of the sets to fit; add error slots or compliances");
  const FitProblem problem{machine,         measurements,     states,
                           states.X_MT,     candidate.varied, candidate.before,
                           candidate.prior, candidate.least,  options.threads};
  std::vector<Configuration> loaded;
  const std::vector<SessionFrames> frames =
      first_frames(problem, responses(machine, candidate.varied, states, options.threads, loaded));
  Fit all = fit(problem, frames);

  Identification result;
  std::vector<ParameterSet> kept = options.sets;
  const Ladder ladder(problem, candidate, all, hold_out_groups(problem, options.hold_out));
  const bool has_groups = !ladder.groups().empty();
  if (has_groups && options.ladder) kept = climb(ladder, measurements, options.sets, result.ladder);
  if (has_groups) add_held_out(ladder, problem, kept, result.held_out);

  const Eigen::VectorXd prior = ladder.prior_of(kept);
  FitProblem last = problem;
  last.prior = prior;
  const Fit final_fit = kept.size() == options.sets.size() ? all : fit(last, frames);
  result.covariance = final_fit.covariance;
  if (has_groups) widen_by_groups(ladder, kept, result.covariance);
  result.iterations = final_fit.iterations;
  result.repeatability = repeatability_of(measurements);
  fill_parameters(machine, candidate, final_fit, prior, result);
  fill_rows(problem, final_fit, result);
  return result;
}

}  // namespace counterflex
