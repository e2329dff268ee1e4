#include "forces/fit/program_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Of the coarse search: at most this many steps over log and program, and this part of the program must be in
// the log.
constexpr std::size_t most_steps = 4000;
constexpr double least_overlap = 0.5;
// Of the fine search: steps of an interval between samples.
constexpr double fine_steps = 8;
// Parts of the program in which the offset is followed, from each to the next within this part of its
// duration. A part that correlates less has no change of the cut.
constexpr std::size_t part_count = 8;
constexpr double part_search = 0.1, least_correlation = 0.5;

bool same(const SpindleMove& a, const SpindleMove& b) {
  return a.kind == b.kind && a.rpm == b.rpm && a.group == b.group && a.chip_torque == b.chip_torque &&
         a.edge_torque == b.edge_torque;
}

/// Sums of a linear regression of y on x.
struct Regression {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  /// Ignores an unknown x (NaN).
  void add(double xi, double yi) {
    if (std::isnan(xi)) return;
    n += 1;
    x += xi;
    y += yi;
    xx += xi * xi;
    yy += yi * yi;
    xy += xi * yi;
  }
  /// Of x and y; 0 where one of them is constant.
  double correlation() const {
    if (!(n > 2)) return 0;
    const double sxx = xx - x * x / n, syy = yy - y * y / n, sxy = xy - x * y / n;
    return sxx > 0 && syy > 0 ? sxy / std::sqrt(sxx * syy) : 0;
  }
};

/// The correlation of the samples whose program time is in [from, to] at an offset.
double correlation(const SpindleLog& log, const ProgramTime& program, double offset, double from, double to) {
  Regression sums;
  const auto first = std::lower_bound(log.samples.begin(), log.samples.end(), from + offset,
                                      [](const SpindleSample& sample, double t) { return sample.key < t; });
  for (auto at = first; at != log.samples.end() && at->key <= to + offset; ++at)
    sums.add(program.value(at->key - offset), at->value);
  return sums.correlation();
}

/// The middle of the offsets of the best correlation, `step` apart around `middle`.
double best_offset(const SpindleLog& log, const ProgramTime& program, double middle, double reach,
                   double step, double from, double to) {
  constexpr double equal = 1e-9;
  double best = -2, first = middle, last = middle;
  const int steps = static_cast<int>(std::ceil(reach / step));
  for (int k = -steps; k <= steps; ++k) {
    const double offset = middle + k * step, found = correlation(log, program, offset, from, to);
    if (found > best + equal) best = found, first = offset;
    if (found > best - equal) last = offset;
  }
  return (first + last) / 2;
}

/// Means of the log in steps of time; steps without a sample repeat the one before.
std::vector<double> in_steps(const SpindleLog& log, double step) {
  const double t0 = log.samples.front().key, length = log.samples.back().key - t0;
  const auto count = static_cast<std::size_t>(length / step) + 1;
  std::vector<double> sums(count), counts(count);
  for (const SpindleSample& sample : log.samples) {
    const auto k = std::min(static_cast<std::size_t>((sample.key - t0) / step), count - 1);
    sums[k] += sample.value;
    counts[k] += 1;
  }
  for (std::size_t k = 0; k < count; ++k) sums[k] = counts[k] > 0 ? sums[k] / counts[k] : sums[k - 1];
  return sums;
}

/// The offset of the best correlation in steps.
double coarse_offset(const SpindleLog& log, const ProgramTime& program, double step) {
  const std::vector<double> values = in_steps(log, step);
  const auto logged = static_cast<long>(values.size());
  const long length = std::max(1L, static_cast<long>(program.duration() / step));
  std::vector<double> expected;
  for (long i = 0; i < length; ++i) expected.push_back(program.value((static_cast<double>(i) + 0.5) * step));
  const long overlap = std::max(1L, static_cast<long>(least_overlap * static_cast<double>(length)));
  double best = -2;
  long at = 0;
  for (long shift = overlap - length; shift <= logged - overlap; ++shift) {
    Regression sums;
    for (long i = std::max(0L, -shift); i < std::min(length, logged - shift); ++i)
      sums.add(expected[static_cast<std::size_t>(i)], values[static_cast<std::size_t>(i + shift)]);
    // Of equal correlations that over more of the program.
    const double found = sums.correlation() * std::sqrt(sums.n / static_cast<double>(length));
    if (found > best) best = found, at = shift;
  }
  return log.samples.front().key + static_cast<double>(at) * step;
}

}  // namespace

double per_torque(SpindleChannel channel, double rpm) {
  return channel == SpindleChannel::power ? 2 * pi * rpm / 60 : 1;
}

double interval_of(const SpindleLog& log) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < log.samples.size(); ++i)
    intervals.push_back(log.samples[i].key - log.samples[i - 1].key);
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

ProgramTime::ProgramTime(const SpindleLog& log, const std::vector<SpindleMove>& moves)
    : channel_(log.channel) {
  double end = 0;
  for (const SpindleMove& move : moves) {
    if (!(move.seconds > 0)) continue;
    end += move.seconds;
    if (!moves_.empty() && same(moves_.back(), move)) {
      ends_.back() = end;
      continue;
    }
    moves_.push_back(move);
    ends_.push_back(end);
  }
}

std::size_t ProgramTime::index(double t) const {
  return static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), t) - ends_.begin());
}

const SpindleMove* ProgramTime::at(double t) const {
  return t < 0 || t >= duration() ? nullptr : &moves_[index(t)];
}

double ProgramTime::to_change(double t) const {
  if (t < 0 || t >= duration()) return 0;
  const std::size_t i = index(t);
  return std::min(ends_[i] - t, t - (i == 0 ? 0 : ends_[i - 1]));
}

double ProgramTime::value(double t) const {
  const SpindleMove* move = at(t);
  if (move == nullptr || move->kind == SpindleMove::Kind::air) return 0;
  if (move->kind == SpindleMove::Kind::unknown) return std::numeric_limits<double>::quiet_NaN();
  return per_torque(channel_, move->rpm) * (move->chip_torque + move->edge_torque);
}

double find_offset(const SpindleLog& log, const ProgramTime& program) {
  const double length = log.samples.back().key - log.samples.front().key + program.duration();
  const double step = std::max(interval_of(log), length / static_cast<double>(most_steps));
  const double coarse = coarse_offset(log, program, step);
  return refine_offset(log, program,
                       best_offset(log, program, coarse, 2 * step, step / 10, 0, program.duration()));
}

double refine_offset(const SpindleLog& log, const ProgramTime& program, double offset) {
  const double interval = interval_of(log);
  return best_offset(log, program, offset, 2 * interval, interval / fine_steps, 0, program.duration());
}

double drift_of(const SpindleLog& log, const ProgramTime& program, double offset) {
  const double duration = program.duration() / part_count, interval = interval_of(log);
  const double reach = part_search * duration, rough = std::max(interval, reach / 50);
  const auto quality = [&](std::size_t part, double at) {
    const double from = static_cast<double>(part) * duration;
    return correlation(log, program, at, from, from + duration);
  };
  const auto follow = [&](std::size_t part, double before) {
    const double from = static_cast<double>(part) * duration, to = from + duration;
    const double near = best_offset(log, program, before, reach, rough, from, to);
    const double best =
        best_offset(log, program, near, 2 * rough, std::max(interval / fine_steps, rough / 50), from, to);
    return quality(part, best) < least_correlation ? before : best;
  };
  std::size_t start = 0;
  for (std::size_t part = 1; part < part_count; ++part)
    if (quality(part, offset) > quality(start, offset)) start = part;
  const double first = follow(start, offset);
  double least = first, most = first, at = first;
  const auto take = [&](double found) {
    least = std::min(least, found);
    most = std::max(most, found);
    return found;
  };
  for (std::size_t part = start + 1; part < part_count; ++part) at = take(follow(part, at));
  at = first;
  for (std::size_t part = start; part-- > 0;) at = take(follow(part, at));
  return most - least;
}

}  // namespace counterflex
