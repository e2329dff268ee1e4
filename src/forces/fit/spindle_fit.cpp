#include "counterflex/forces/spindle_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "counterflex/files/csv_text.hpp"
#include "forces/fit/program_time.hpp"

namespace counterflex {
namespace {

using Kind = SpindleMove::Kind;

// Fewer samples of an air cut or of a group are too few. Samples nearer to a change than this many intervals
// may show both sides of it.
constexpr std::size_t least_samples = 10;
constexpr double margin_intervals = 2;
// Part of the program's duration that the offset may change; part of the log's variation that the fit must
// explain.
constexpr double most_drift = 0.01, least_explained = 0.5;

/// A sample and what the spindle does there.
struct Row {
  const SpindleSample* sample = nullptr;
  const SpindleMove* move = nullptr;
};

[[noreturn]] void refuse(const SpindleLog& log, int row, const std::string& why) {
  csv::fail({log.file, row, 1}, why);
}

/// The samples that are not near to a change, with the moves of their times.
std::vector<Row> rows_at(const SpindleLog& log, const ProgramTime& program, double offset, double margin) {
  std::vector<Row> rows;
  for (const SpindleSample& sample : log.samples) {
    const double t = sample.key - offset;
    const SpindleMove* move = program.at(t);
    if (move != nullptr && move->kind != Kind::unknown && program.to_change(t) >= margin)
      rows.push_back({&sample, move});
  }
  return rows;
}

[[noreturn]] void refuse_drift(const SpindleLog& log, double drift, double most, double end) {
  const auto row = std::find_if(log.samples.begin(), log.samples.end() - 1,
                                [&](const SpindleSample& sample) { return sample.key >= end; });
  refuse(log, row->row,
         fmt::format("the clock of the log drifts: along the program its offset changes by {:.3f} s; it may "
                     "change by {:.3f} s, and less where cuts and air cuts are shorter; state the speed of "
                     "rapid moves in # rapid_mm_min, log without overrides and stops, or log the column line "
                     "instead of t_s",
                     drift, most));
}

/// Whether enough samples are in cuts, and in air cuts.
bool has_both(const std::vector<Row>& rows) {
  const auto cuts = static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.move->kind == Kind::cut; }));
  return cuts >= least_samples && rows.size() - cuts >= least_samples;
}

/// The moves of a line as one; unknown if they differ in kind, group or speed.
std::map<long, SpindleMove> moves_of_lines(const std::vector<SpindleMove>& moves) {
  std::map<long, SpindleMove> lines;
  for (const SpindleMove& move : moves) {
    const auto [at, is_new] = lines.emplace(move.line, move);
    if (is_new) continue;
    SpindleMove& all = at->second;
    if (all.kind != move.kind || all.group != move.group || all.rpm != move.rpm) all.kind = Kind::unknown;
    const double seconds = all.seconds + move.seconds;
    if (!(seconds > 0)) continue;
    const auto mean = [&](double SpindleMove::*torque) {
      all.*torque = (all.*torque * all.seconds + move.*torque * move.seconds) / seconds;
    };
    mean(&SpindleMove::chip_torque);
    mean(&SpindleMove::edge_torque);
    all.seconds = seconds;
  }
  return lines;
}

std::vector<Row> rows_by_line(const SpindleLog& log, const std::map<long, SpindleMove>& lines) {
  std::vector<Row> rows;
  for (const SpindleSample& sample : log.samples) {
    const auto at = lines.find(std::lround(sample.key));
    if (at != lines.end() && at->second.kind != Kind::unknown) rows.push_back({&sample, &at->second});
  }
  return rows;
}

/// The spindle speeds of the rows, each with its number of air cuts.
std::map<double, std::size_t> speeds_of(const std::vector<Row>& rows) {
  std::map<double, std::size_t> speeds;
  for (const Row& row : rows) speeds[row.move->rpm] += row.move->kind == Kind::air;
  return speeds;
}

[[noreturn]] void refuse_no_air(const SpindleLog& log, const Row& cut, std::size_t count, double margin) {
  const std::string away = log.by_line ? "" : fmt::format(", {:.2f} s or more from a change", margin);
  refuse(
      log, cut.sample->row,
      fmt::format(
          "the log has no air cuts at {:.6g} 1/min: {} samples in rapid moves or above --air-above{}, "
          "and the idle {} needs {}; {}add a longer move above the part, and state --air-above",
          cut.move->rpm, count, away, log.channel == SpindleChannel::power ? "power" : "torque",
          least_samples,
          log.by_line || log.rapid_m_s > 0 ? "" : "state the speed of rapid moves in # rapid_mm_min, or "));
}

/// Drops air cuts at speeds without a cut, and refuses cuts at speeds without an air cut.
void settle_speeds(const SpindleLog& log, std::vector<Row>& rows, double margin) {
  const std::map<double, std::size_t> air = speeds_of(rows);
  std::map<double, bool> cuts;
  for (const Row& row : rows) {
    if (row.move->kind != Kind::cut) continue;
    cuts[row.move->rpm] = true;
    if (const std::size_t count = air.at(row.move->rpm); count < least_samples)
      refuse_no_air(log, row, count, margin);
  }
  if (cuts.empty())
    refuse(log, log.samples.front().row,
           "no sample is in a cut of the program; check that log, program and cutting model belong together");
  std::erase_if(rows, [&](const Row& row) { return !cuts.contains(row.move->rpm); });
}

/// The least-squares problem: columns are the idle values of the speeds, then the scales of the groups.
struct Problem {
  std::vector<double> speeds;
  std::vector<std::size_t> groups;  ///< that have samples
  Eigen::MatrixXd A;
  Eigen::VectorXd y;
};

Problem problem_of(const SpindleLog& log, const std::vector<Row>& rows, std::size_t groups) {
  Problem problem;
  std::vector<std::size_t> counts(groups);
  for (const Row& row : rows) counts[row.move->group] += row.move->kind == Kind::cut;
  for (std::size_t g = 0; g < groups; ++g)
    if (counts[g] >= least_samples) problem.groups.push_back(g);
  for (const auto& [rpm, count] : speeds_of(rows)) problem.speeds.push_back(rpm);
  const auto columns = static_cast<Eigen::Index>(problem.speeds.size() + problem.groups.size());
  problem.A = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), columns);
  problem.y.resize(problem.A.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SpindleMove& move = *rows[i].move;
    const auto row = static_cast<Eigen::Index>(i);
    const double f = per_torque(log.channel, move.rpm);
    const auto speed = std::lower_bound(problem.speeds.begin(), problem.speeds.end(), move.rpm);
    problem.A(row, speed - problem.speeds.begin()) = 1;
    problem.y[row] = rows[i].sample->value;
    if (move.kind != Kind::cut) continue;
    problem.y[row] -= f * move.edge_torque;
    const auto group = std::lower_bound(problem.groups.begin(), problem.groups.end(), move.group);
    problem.A(row, static_cast<Eigen::Index>(problem.speeds.size()) + (group - problem.groups.begin())) =
        f * move.chip_torque;
  }
  return problem;
}

/// The correlation of neighbouring residuals, from 0 to 0.99.
double neighbours(const Eigen::VectorXd& r) {
  const double sum = r.head(r.size() - 1).dot(r.tail(r.size() - 1));
  return r.squaredNorm() > 0 ? std::clamp(sum / r.squaredNorm(), 0.0, 0.99) : 0;
}

/// The least-squares solution of rows.
struct Solution {
  std::vector<Row> rows;
  Problem problem;
  Eigen::VectorXd x, residuals;
  Eigen::MatrixXd inverse;  ///< of the normal matrix
};

/// `margin`: of the rows, to a change (s).
Solution solve(const SpindleLog& log, std::vector<Row> rows, std::size_t groups, double margin) {
  settle_speeds(log, rows, margin);
  std::vector<std::size_t> counts(groups);
  for (const Row& row : rows) counts[row.move->group] += row.move->kind == Kind::cut;
  std::erase_if(rows, [&](const Row& row) {
    return row.move->kind == Kind::cut && counts[row.move->group] < least_samples;
  });
  Solution solution{.rows = std::move(rows)};
  solution.problem = problem_of(log, solution.rows, groups);
  const Problem& problem = solution.problem;
  if (problem.groups.empty())
    refuse(log, log.samples.front().row,
           fmt::format("no cutter has {} samples in its cuts, away from changes; log faster, or longer cuts",
                       least_samples));
  const Eigen::MatrixXd N = problem.A.transpose() * problem.A;
  solution.inverse = N.ldlt().solve(Eigen::MatrixXd::Identity(N.rows(), N.cols()));
  solution.x = solution.inverse * (problem.A.transpose() * problem.y);
  solution.residuals = problem.y - problem.A * solution.x;
  return solution;
}

void refuse_stranger(const SpindleLog& log, const Solution& solution) {
  const Eigen::VectorXd& y = solution.problem.y;
  const double variation = (y.array() - y.mean()).matrix().squaredNorm();
  const double rest = solution.residuals.squaredNorm();
  if (rest > (1 - least_explained) * variation)
    refuse(log, log.samples.front().row,
           fmt::format("the log does not follow the program: the fit explains {:.0f} % of its variation, it "
                       "must explain {:.0f} %; check that log, program and cutting model belong together, "
                       "and that the clock of "
                       "the log does not drift",
                       100 * (1 - rest / variation), 100 * least_explained));
}

/// The moves with the found coefficients, which correlate better with the log than those with the given ones.
std::vector<SpindleMove> scaled(std::vector<SpindleMove> moves, const Solution& solution) {
  const std::vector<std::size_t>& groups = solution.problem.groups;
  for (SpindleMove& move : moves) {
    const auto at = std::find(groups.begin(), groups.end(), move.group);
    if (move.kind != Kind::cut || at == groups.end()) continue;
    move.chip_torque *=
        solution.x[static_cast<Eigen::Index>(solution.problem.speeds.size()) + (at - groups.begin())];
  }
  return moves;
}

/// Finds the offset with the given coefficients, and again with those that this offset gives. Sets offset and
/// drift.
Solution solve_by_time(const SpindleLog& log, const std::vector<SpindleMove>& moves,
                       const ProgramTime& program, std::size_t groups, SpindleFit& fit) {
  if (log.samples.size() < 2 * least_samples)
    refuse(
        log, log.samples.back().row,
        fmt::format("the log has {} rows; a fit needs at least {}", log.samples.size(), 2 * least_samples));
  const double margin = margin_intervals * interval_of(log);
  fit.offset = find_offset(log, program);
  const Solution first = solve(log, rows_at(log, program, fit.offset, margin), groups, margin);
  const ProgramTime found(log, scaled(moves, first));
  fit.offset = refine_offset(log, found, fit.offset);
  fit.drift = drift_of(log, found, fit.offset);
  const double T = program.duration(), most = std::max(most_drift * T, 2 * margin);
  const double away = margin + fit.drift;
  std::vector<Row> rows = rows_at(log, program, fit.offset, away);
  if (fit.drift > most || !has_both(rows)) refuse_drift(log, fit.drift, most, T + fit.offset);
  return solve(log, std::move(rows), groups, away);
}

}  // namespace

SpindleFit fit_spindle(const SpindleLog& log, const std::vector<SpindleMove>& moves, std::size_t groups) {
  SpindleFit fit;
  const ProgramTime program(log, moves);
  const std::map<long, SpindleMove> lines = moves_of_lines(moves);
  const Solution solution = log.by_line ? solve(log, rows_by_line(log, lines), groups, 0)
                                        : solve_by_time(log, moves, program, groups, fit);
  refuse_stranger(log, solution);
  const auto& [rows, problem, x, r, inverse] = solution;
  fit.samples = rows.size();
  fit.residual = std::sqrt(r.squaredNorm() / static_cast<double>(r.size()));
  fit.correlation = neighbours(r);
  const double s2 = r.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(r.size() - x.size(), 1)) *
                    (1 + fit.correlation) / (1 - fit.correlation);
  const auto value = [&](std::size_t column) {
    const auto k = static_cast<Eigen::Index>(column);
    const auto count = static_cast<std::size_t>((solution.problem.A.col(k).array() != 0).count());
    return SpindleFit::Value{solution.x[k], std::sqrt(s2 * solution.inverse(k, k)), count};
  };
  for (std::size_t k = 0; k < problem.speeds.size(); ++k) {
    fit.idle.push_back({problem.speeds[k], value(k)});
    fit.idle.back().value.samples = speeds_of(rows).at(problem.speeds[k]);
  }
  fit.scales.resize(groups);
  for (std::size_t g = 0; g < problem.groups.size(); ++g)
    fit.scales[problem.groups[g]] = value(problem.speeds.size() + g);
  return fit;
}

}  // namespace counterflex
