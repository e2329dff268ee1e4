#include "identify/ladder.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "identify/ranges.hpp"

namespace counterflex {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

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

}  // namespace

Ladder::Ladder(const FitProblem& problem, const Candidates& candidates, const Fit& all,
               std::vector<RowGroup> groups)
    : problem_(problem), candidates_(candidates), all_(all), groups_(std::move(groups)) {
  for (const RowGroup& group : groups_) {
    std::vector<bool> is_held(all.rows.size(), false);
    for (const std::size_t row : group.rows) is_held[row] = true;
    training_.push_back(normal_matrices(
        all.rows, unknowns_of(problem, all.frames), all.values.size(),
        [&](std::size_t i) { return !is_held[i]; }, problem.threads));
  }
}

bool Ladder::has(ParameterSet set) const {
  return std::find(candidates_.set.begin(), candidates_.set.end(), set) != candidates_.set.end();
}

FitStep Ladder::trained(const std::vector<ParameterSet>& sets, std::size_t group) const {
  const Eigen::VectorXd prior = prior_of(candidates_, sets);
  Eigen::VectorXd back = Eigen::VectorXd::Zero(prior.size());
  for (Eigen::Index k = 0; k < prior.size(); ++k)
    if (prior[k] == 0) back[k] = problem_.before[k] - all_.values[k];
  NormalMatrices normal = training_[group];
  move(back, normal);
  FitStep step = solve(normal, unknowns_of(problem_, all_.frames), all_.values - problem_.before,
                       {prior, problem_.correlation});
  step.parameters += back;
  return step;
}

std::vector<RowErrors> Ladder::errors(const std::vector<ParameterSet>& sets) const {
  std::vector<RowErrors> result;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    result.push_back(errors_of(problem_, groups_[g], all_, trained(sets, g)));
  return result;
}

std::vector<ParameterSet> climb(const Ladder& ladder, const FitProblem& problem,
                                const std::vector<ParameterSet>& sets, std::vector<LadderStep>& steps) {
  const Measurements& measurements = problem.measurements;
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
    step.left = left_range(problem, ladder.groups(), set);
    step.is_kept = gain > step.gain_scatter && !step.left;
    if (step.is_kept) {
      kept = with;
      now = next;
    }
    steps.push_back(step);
  }
  return kept;
}

std::vector<HeldOutGroup> held_out(const Ladder& ladder, const Measurements& measurements,
                                   const std::vector<ParameterSet>& kept) {
  struct Errors {
    std::vector<double> distance, angle;
  };
  struct Kind {
    Errors before, after;
    std::vector<double> in_interval;
  };
  std::vector<HeldOutGroup> list;
  const std::vector<RowErrors> before = ladder.errors({}), after = ladder.errors(kept);
  for (std::size_t g = 0; g < before.size(); ++g) {
    std::map<std::pair<MeasurementKind, bool>, Kind> kinds;  // with whether values are lengths
    const auto kind_of = [&](std::size_t row) {
      const Measurement& measured = measurements.rows[row];
      return std::pair{measurements.sessions[measured.session].kind, measured.is_length};
    };
    const auto add = [&](const RowErrors& errors, Errors Kind::*side) {
      std::size_t angle = 0;
      for (std::size_t k = 0; k < errors.rows.size(); ++k) {
        const auto kind = kind_of(errors.rows[k]);
        (kinds[kind].*side).distance.push_back(errors.distance[k]);
        if (kind.first == MeasurementKind::tracker_pose)
          (kinds[kind].*side).angle.push_back(errors.angle[angle++]);
      }
    };
    add(before[g], &Kind::before);
    add(after[g], &Kind::after);
    for (std::size_t k = 0; k < after[g].rows.size(); ++k)
      kinds[kind_of(after[g].rows[k])].in_interval.push_back(after[g].in_interval[k]);
    for (const auto& [kind, all] : kinds)
      list.push_back({ladder.groups()[g].name, kind.first, kind.second, summary(all.before.distance),
                      summary(all.after.distance), summary(all.before.angle), summary(all.after.angle),
                      mean_of(all.in_interval)});
  }
  return list;
}

void widen_by_groups(const Ladder& ladder, const std::vector<ParameterSet>& kept,
                     Eigen::MatrixXd& covariance) {
  const auto groups = static_cast<double>(ladder.groups().size());
  if (groups < 2) return;
  std::vector<Eigen::VectorXd> values;
  for (std::size_t g = 0; g < ladder.groups().size(); ++g)
    values.push_back(ladder.trained(kept, g).parameters);
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

}  // namespace counterflex
