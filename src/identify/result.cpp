#include "identify/result.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace counterflex {
namespace {

constexpr double strong_correlation = 0.9;
constexpr double least_part = 0.3;  // of its deviation: a parameter of a free combination that changes less
constexpr std::size_t most_outliers = 50, most_worst = 10;

/// Reduced row echelon form with full pivoting: every row has a column of its own.
void reduce(Eigen::MatrixXd& rows) {
  std::vector<bool> is_done(static_cast<std::size_t>(rows.rows()), false);
  for (Eigen::Index step = 0; step < rows.rows(); ++step) {
    Eigen::Index row = 0, column = 0;
    double largest = -1;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      Eigen::Index at = 0;
      const double size = rows.row(i).cwiseAbs().maxCoeff(&at);
      if (is_done[static_cast<std::size_t>(i)] || size <= largest) continue;
      largest = size;
      row = i;
      column = at;
    }
    is_done[static_cast<std::size_t>(row)] = true;
    rows.row(row) /= rows(row, column);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      if (i != row) rows.row(i) -= rows(i, column) * rows.row(row);
  }
}

/// The directions whose deviation stays above half of the prior one, each with as few parameters as possible.
std::vector<FreeCombination> free_combinations(const std::vector<IdentifiedParameter>& parameters,
                                               const Eigen::MatrixXd& covariance) {
  if (parameters.empty()) return {};
  const auto n = static_cast<Eigen::Index>(parameters.size());
  if (n == 0) return {};
  Eigen::VectorXd prior(n);
  for (Eigen::Index k = 0; k < n; ++k) prior[k] = parameters[static_cast<std::size_t>(k)].prior;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(prior.cwiseInverse().asDiagonal() * covariance *
                                                             prior.cwiseInverse().asDiagonal());
  const auto count = (eigen.eigenvalues().array() > identified_share * identified_share).count();
  Eigen::MatrixXd rows = eigen.eigenvectors().rightCols(count).transpose();
  reduce(rows);
  std::vector<FreeCombination> found;
  for (const auto& row : rows.rowwise()) {
    FreeCombination free;
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::abs(row[k]) * prior[k] > least_part * std::sqrt(covariance(k, k)))
        free.terms.push_back({parameters[static_cast<std::size_t>(k)].name, row[k] * prior[k]});
    if (free.terms.size() > 1) found.push_back(std::move(free));
  }
  return found;
}

}  // namespace

void fill_parameters(const Machine& machine, const Candidates& candidates, const Fit& fit,
                     const Eigen::VectorXd& prior, const Eigen::MatrixXd& covariance,
                     Identification& result) {
  const std::vector<Parameter> all = parameters(machine);
  std::vector<double> values;
  for (const Parameter& parameter : all) values.push_back(parameter.value);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < prior.size(); ++k) {
    if (prior[k] == 0) continue;
    kept.push_back(k);
    const std::size_t index = candidates.varied[static_cast<std::size_t>(k)];
    const double sigma = std::min(std::sqrt(covariance(k, k)), prior[k]);
    result.parameters.push_back(
        {all[index].name, all[index].kind, all[index].unit, all[index].value, fit.values[k], prior[k], sigma,
         candidates.is_default[static_cast<std::size_t>(k)], sigma < identified_share * prior[k]});
    values[index] = fit.values[k];
  }
  result.machine = with_parameters(machine, values);
  result.covariance = covariance(kept, kept);
  result.free = free_combinations(result.parameters, fit.covariance(kept, kept));
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
  double squares = 0, stated = 0;
  std::size_t count = 0, with_sigma = 0;
  for (std::size_t i = 0; i < fit.rows.size(); ++i) {
    const LinearRow& row = fit.rows[i];
    const Measurement& measured = problem.measurements.rows[i];
    const double error = row.at.is_found ? row.at.r.head(row.at.distances).norm() * measured.sigma : 0;
    ratios.emplace_back(ratio(row), i);
    if (row.weight == 0 || !row.at.is_found)
      result.outliers.push_back(
          {measured.at, problem.measurements.sessions[row.session].name, error, ratio(row)});
    else {
      if (measured.is_length) squares += error * error, ++count;
      if (!problem.measurements.sessions[row.session].sigma_given) continue;
      stated += error * error / (measured.sigma * measured.sigma * static_cast<double>(row.at.distances));
      ++with_sigma;
    }
  }
  if (with_sigma > 0) result.misfit = std::sqrt(stated / static_cast<double>(with_sigma));
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

}  // namespace counterflex
