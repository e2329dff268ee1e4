#pragma once
/// What a place does when the force on it changes a little.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "target_waves.hpp"

namespace counterflex {

/// Neighbouring pieces share one response: S with dp = S dF to first order, p the correction or the tip (m).
inline constexpr std::size_t response_span = 64;

struct ForceResponse {
  Vector6 probes =
      Vector6::Zero();            ///< sizes of the changes by which it is measured (N, N m), 0: none needed
  Answer place = no_answer;       ///< where it is measured
  std::array<Answer, 6> asked{};  ///< by component, where its probe is not 0
  Eigen::Matrix<double, 3, 6> S = Eigen::Matrix<double, 3, 6>::Zero();  ///< m/N, m/(N m)
  bool known = true;                                                    ///< false: a probe failed

  /// Makes the probes as large as a change of force that S will be used for; `F` is the force there.
  void provide_for(const Vector6& dF, const Vector6& F) {
    constexpr double rounding = 1e-9;
    for (int k = 0; k < 6; ++k)
      if (std::abs(dF[k]) > rounding * (1 + std::abs(F[k]))) probes[k] = std::max(probes[k], std::abs(dF[k]));
  }

  bool is_needed() const { return !probes.isZero(0); }

  template <class Ask>  // Answer(const Vector6& dF)
  void ask(const Ask& ask_under) {
    for (int k = 0; k < 6; ++k)
      if (probes[k] > 0)
        asked[static_cast<std::size_t>(k)] = ask_under(Vector6(probes[k] * Vector6::Unit(k)));
  }

  template <class Change>  // std::optional<Vector3>(Answer)
  void measure(const Change& change) {
    for (int k = 0; k < 6; ++k) {
      if (probes[k] == 0) continue;
      const auto moved = change(asked[static_cast<std::size_t>(k)]);
      known = known && moved;
      if (moved) S.col(k) = *moved / probes[k];
    }
  }
};

/// Pieces in a row of which one is looked into for all.
inline constexpr std::size_t row_of_pieces = 8;

/// By how much of it the bend by the force may be other than foreseen.
inline constexpr double bend_error = 0.3;

/// Of the tolerance, or of what of it is left: what is found inside a line may be other than foreseen by so
/// much.
inline constexpr double foreseen_share = 0.025;

/// Whether what was found inside a line is as foreseen, with a bend by the force (m); `room`: the tolerance,
/// or what of it is left (m).
inline bool is_as_foreseen(const Vector3& found, const Vector3& foreseen, const Vector3& bend, double room) {
  return (found - foreseen).norm() <= foreseen_share * room + bend_error * bend.norm();
}

/// Lines shorter than this part of the machine's length l bend, if at all, as their neighbours do.
inline constexpr double short_line = 0.02;

/// By how much the force inside a line is other than on the straight line between its ends.
struct ForceBend {
  double at;  ///< fraction of the line
  Vector6 dF;
};

/// Tells a task with `bend` (m) and `bend_at` where along its line the force bends most, and how much.
template <class Task>
void find_bend(Task& task, std::span<const ForceBend> bends, const ForceResponse& response) {
  for (const ForceBend& one : bends) {
    const double bend = (response.S * one.dF).norm();
    if (bend <= task.bend) continue;
    task.bend = bend;
    task.bend_at = one.at;
  }
}

/// Looks into the line of a row that the force bends most, where it does, and into the middle of the longest
/// one, unless the first look stands for both. A task has `length`, `bend` and `room` (m) and `bend_at`, a
/// fraction. No line is looked into twice.
template <class Task, class Look>  // void(std::size_t task, double at)
void look_into_row(std::span<const std::size_t> row, const std::vector<Task>& tasks, const Look& look) {
  const auto most = [&](double Task::*what) {
    return *std::max_element(row.begin(), row.end(),
                             [&](std::size_t a, std::size_t b) { return tasks[a].*what < tasks[b].*what; });
  };
  const std::size_t longest = most(&Task::length), most_bent = most(&Task::bend);
  const Task& bent = tasks[most_bent];
  const bool bends = bent.bend > foreseen_share * bent.room;
  if (bends) look(most_bent, bent.bend_at);
  const bool for_both =
      bends && std::abs(bent.bend_at - 0.5) < 0.25 && tasks[longest].length < 1.5 * bent.length;
  if (!for_both && (!bends || most_bent != longest)) look(longest, 0.5);
}

/// The row of lines that begins at one of them.
inline std::span<const std::size_t> row_from(const std::vector<std::size_t>& lines, std::size_t begin) {
  return std::span(lines).subspan(begin, std::min(row_of_pieces, lines.size() - begin));
}

/// The same for all rows; a row is told by the number of its first line among `lines`.
template <class Task, class Look>  // void(std::size_t row, std::size_t task, double at)
void look_into_rows(const std::vector<std::size_t>& lines, const std::vector<Task>& tasks, const Look& look) {
  for (std::size_t row = 0; row < lines.size(); row += row_of_pieces)
    look_into_row(row_from(lines, row), tasks, [&](std::size_t t, double at) { look(row, t, at); });
}

}  // namespace counterflex
