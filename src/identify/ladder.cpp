#include "identify/ladder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "identify/ranges.hpp"

namespace counterflex {
namespace {

constexpr double not_seen = 0.9;  // of the prior deviation: rows that leave more do not see a parameter

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
  for (const RowErrors& group : errors)
    if (!group.rows.empty()) means.push_back(mean_of(group.distance));
  return mean_of(means);
}

std::vector<std::size_t> merged(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  std::vector<std::size_t> all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

/// Those that a row shows which the other rows cannot predict, and that no test has seen.
std::vector<Eigen::Index> untested_parameters(const std::vector<TestRows>& groups, bool is_tested) {
  std::vector<Eigen::Index> found;
  for (std::size_t k = 0; k < groups[0].seen_by_tests.size(); ++k) {
    bool by_tests = false, by_untested = false;
    for (const TestRows& group : groups) {
      by_tests = by_tests || group.seen_by_tests[k];
      by_untested = by_untested || group.seen_by_untested[k];
    }
    // The rows of one group alone test nothing.
    if (is_tested ? by_untested && !by_tests : by_untested || by_tests)
      found.push_back(static_cast<Eigen::Index>(k));
  }
  return found;
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

Eigen::VectorXd Ladder::prior_of(ParameterSet set) const {
  return counterflex::prior_of(candidates_, {set});
}

FitStep Ladder::trained(const Eigen::VectorXd& prior, std::size_t group) const {
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

std::vector<TestRows> Ladder::tests(const Eigen::VectorXd& prior, const Eigen::VectorXd& tried) const {
  std::vector<TestRows> result;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    result.push_back(test_rows(problem_, groups_[g], all_, trained(prior, g), tried));
  return result;
}

std::vector<RowErrors> Ladder::errors(const Eigen::VectorXd& prior,
                                      const std::vector<std::vector<std::size_t>>& rows) const {
  std::vector<RowErrors> result;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    result.push_back(errors_of(problem_, groups_[g], rows[g], all_, trained(prior, g)));
  return result;
}

Eigen::VectorXd climb(const Ladder& ladder, const FitProblem& problem, const std::vector<ParameterSet>& sets,
                      std::vector<LadderStep>& steps) {
  const Measurements& measurements = problem.measurements;
  const std::vector<Parameter> all = parameters(problem.machine);
  Eigen::VectorXd kept = Eigen::VectorXd::Zero(problem.prior.size());
  for (const ParameterSet set : sets) {
    if (!ladder.has(set)) continue;
    const Eigen::VectorXd with = kept.cwiseMax(ladder.prior_of(set));
    const std::vector<TestRows> tests = ladder.tests(with, with - kept);
    std::vector<std::vector<std::size_t>> rows;
    for (const TestRows& group : tests) {
      rows.push_back(group.tests);
      // Places beyond a range that was measured test errors of motion: these have to be left out there.
      if (depends_on_place(set)) rows.back() = merged(group.tests, group.untested);
    }
    const std::vector<RowErrors> now = ladder.errors(kept, rows), next = ladder.errors(with, rows);
    const std::vector<double> before = relative_means(measurements, now),
                              after = relative_means(measurements, next);
    std::vector<double> gains;
    for (std::size_t g = 0; g < before.size(); ++g)
      if (!rows[g].empty()) gains.push_back(before[g] > 0 ? (before[g] - after[g]) / before[g] : 0);
    LadderStep step{set, mean_error(now), mean_error(next)};
    step.is_tested = gains.size() >= 2;
    step.left = left_range(problem, ladder.groups(), set);
    if (step.is_tested) {
      step.gain = mean_of(gains);
      double squares = 0;
      for (const double g : gains) squares += (g - step.gain) * (g - step.gain);
      const auto count = static_cast<double>(gains.size());
      step.gain_scatter = std::sqrt(squares / (count * (count - 1)));
      step.is_kept = step.gain > step.gain_scatter && !step.left;
    }
    if (step.is_kept)
      kept = with;
    else if (!depends_on_place(set))
      for (const Eigen::Index k : untested_parameters(tests, step.is_tested)) {
        kept[k] = with[k];
        step.untested.push_back(all[problem.varied[static_cast<std::size_t>(k)]].name);
      }
    steps.push_back(step);
  }
  return kept;
}

std::vector<HeldOutGroup> held_out(const Ladder& ladder, const Measurements& measurements,
                                   const Eigen::VectorXd& kept, std::size_t& untested) {
  struct Errors {
    std::vector<double> distance, angle;
  };
  struct Kind {
    Errors before, after;
    std::vector<double> in_interval;
  };
  std::vector<HeldOutGroup> list;
  std::vector<std::vector<std::size_t>> rows;
  for (const TestRows& group : ladder.tests(kept, kept)) {
    rows.push_back(merged(group.tests, group.blind));
    untested += group.untested.size();
  }
  const std::vector<RowErrors> before = ladder.errors(Eigen::VectorXd::Zero(kept.size()), rows),
                               after = ladder.errors(kept, rows);
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

void widen_by_groups(const Ladder& ladder, const Eigen::VectorXd& kept, Eigen::MatrixXd& covariance) {
  const auto groups = static_cast<double>(ladder.groups().size());
  if (groups < 2) return;
  std::vector<FitStep> fits;
  for (std::size_t g = 0; g < ladder.groups().size(); ++g) fits.push_back(ladder.trained(kept, g));
  // The 99 % quantile of chi^2 over its freedoms, by Wilson and Hilferty.
  const double f = groups - 1, chance = std::pow(1 - 2 / (9 * f) + 2.326 * std::sqrt(2 / (9 * f)), 3);
  for (Eigen::Index k = 0; k < kept.size(); ++k) {
    double mean = 0, squares = 0, largest = 0;
    for (const FitStep& fit : fits) mean += fit.parameters[k] / groups;
    for (const FitStep& fit : fits) {
      squares += (fit.parameters[k] - mean) * (fit.parameters[k] - mean);
      largest = std::max(largest, fit.covariance(k, k));
    }
    if (largest > not_seen * not_seen * kept[k] * kept[k]) continue;
    const double jackknife = (groups - 1) / groups * squares;
    if (!(jackknife > chance * covariance(k, k)) || !(covariance(k, k) > 0)) continue;
    const double factor = std::sqrt(jackknife / covariance(k, k));
    covariance.row(k) *= factor;
    covariance.col(k) *= factor;
  }
}

}  // namespace counterflex
