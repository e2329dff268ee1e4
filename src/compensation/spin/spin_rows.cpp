#include "compensation/spin/spin_rows.hpp"

#include <algorithm>
#include <limits>

#include "compensation/solve/branch.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/arm_margins.hpp"

namespace counterflex {
namespace {

constexpr float forbidden = std::numeric_limits<float>::infinity();
constexpr std::size_t places_at_once = 64;  // full batches
constexpr double travel_room = spin_step;   // of turned axes to the end of their travel
constexpr double stated_room = 0.5 * deg;   // to the border of a stated turn
constexpr double largest_step = 60 * deg;   // of an axis for a step of the grid: more is another way

double margin_of(const Model& model, const Configuration& nominal) {
  if (const auto margin = arm_margin(model, nominal)) return margin->angle;
  return 1 / actuator_jacobian(model, nominal).condition;
}

class RowSolver {
 public:
  RowSolver(const Job& job, std::span<const SpinRequest> requests, std::span<SpinRow> rows)
      : solver_(job), requests_(requests), rows_(rows) {}

  void run() {
    for (SpinRow& row : rows_) row.deviation.fill(forbidden);
    std::vector<std::size_t> all(rows_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const std::vector<std::size_t> reached = solve(all, spin_zero, spin_zero);
    for (SpinRow& row : rows_)
      if (row.deviation[spin_zero] == forbidden) row.deviation[spin_zero] = 0;
    for (const int side : {-1, 1}) {
      std::vector<std::size_t> alive = reached;
      for (int turn = spin_zero + side; turn >= 0 && turn < spin_count && !alive.empty(); turn += side)
        alive = solve(alive, turn, turn - side);
    }
  }

 private:
  // The rows whose machine comes to `turn` from the turn `last`.
  std::vector<std::size_t> solve(const std::vector<std::size_t>& rows, int turn, int last) {
    forwards_.clear();
    for (const std::size_t i : rows) {
      forwards_.push_back(requests_[i].command);
      forwards_.back().within_travel = true;
      forwards_.back().R = turned(requests_[i], turn);
    }
    answers_.assign(rows.size(), {});
    solver_.forwards(forwards_, answers_, StopAt::end);
    std::vector<std::size_t> reached;  // of the answers
    places_.clear();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (answers_[k].status != Status::converged || !count_on(rows[k], turn, last, answers_[k].rho))
        continue;
      reached.push_back(k);
      places_.push_back({forwards_[k].model, forwards_[k].target, forwards_[k].R});
    }
    const std::vector<NominalResult> nominals = solver_.nominals(places_);
    std::vector<std::size_t> alive;
    for (std::size_t n = 0; n < reached.size(); ++n) {
      if (nominals[n].status != Status::converged) continue;
      const std::size_t i = rows[reached[n]];
      take(i, turn, answers_[reached[n]], nominals[n].configuration);
      alive.push_back(i);
    }
    return alive;
  }

  static Matrix3 turned(const SpinRequest& request, int turn) {
    return request.wanted.R * exp_so3((turn - spin_zero) * spin_step * Vector3::UnitZ());
  }

  // Counts the actuators on from the turn `last`; false if that is too far.
  bool count_on(std::size_t i, int turn, int last, Eigen::VectorXd& rho) const {
    if (turn == last) return true;
    const Eigen::VectorXd& near = rows_[i].rho[last];
    rho += full_turns(requests_[i].command.model->mechanism, rho, near);
    return (rho - near).cwiseAbs().maxCoeff() <= largest_step;
  }

  void take(std::size_t i, int turn, ForwardAnswer& answer, const Configuration& nominal) {
    const SpinRequest& request = requests_[i];
    SpinRow& row = rows_[i];
    const auto at = static_cast<std::size_t>(turn);
    row.margin[at] = static_cast<float>(margin_of(*request.command.model, nominal));
    row.deviation[at] = static_cast<float>((answer.X_MT.p - request.wanted.p).norm());
    row.rho[at] = std::move(answer.rho);
  }

  PlaceSolver solver_;
  std::span<const SpinRequest> requests_;
  std::span<SpinRow> rows_;
  std::vector<ForwardRequest> forwards_;
  std::vector<ForwardAnswer> answers_;
  std::vector<TipPosition> places_;
};

bool has_room(const Mechanism& mechanism, const Eigen::VectorXd& shown) {
  for (std::size_t a = 0; a < mechanism.travel.size(); ++a) {
    const Travel& travel = mechanism.travel[a];
    const double room = travel.kind == JointKind::revolute ? travel_room : 0, value = shown[a];
    if (value < travel.min + room || value > travel.max - room) return false;
  }
  return true;
}

}  // namespace

std::vector<SpinRow> solve_rows(const Job& job, std::span<const SpinRequest> requests) {
  std::vector<SpinRow> rows(requests.size());
  const auto solve = [&](std::size_t begin, std::size_t count) {
    RowSolver(job, requests.subspan(begin, count), std::span(rows).subspan(begin, count)).run();
  };
  for_each_slice(rows.size(), job.options.threads, solve, places_at_once);
  return rows;
}

void keep_travel(const SpinRequest& request, Eigen::VectorXd& counted, SpinRow& row) {
  const Eigen::VectorXd& programmed = row.rho[spin_zero];
  if (programmed.size() == 0) return;  // it is not reached
  const Mechanism& mechanism = request.command.model->mechanism;
  if (counted.size() != programmed.size()) counted = programmed;
  const Eigen::VectorXd turns = full_turns(mechanism, programmed, counted);
  counted = programmed + turns;
  const Eigen::VectorXd shown = shown_values(mechanism.shown, counted);
  for (std::size_t turn = 0; turn < spin_count; ++turn) {
    if (turn == spin_zero || row.deviation[turn] == forbidden) continue;
    const Eigen::VectorXd there = shown_values(mechanism.shown, row.rho[turn] + turns);
    if (!has_room(mechanism, there) ||
        axis_beyond_stated_turn(request.turns, mechanism, shown, there, stated_room))
      row.deviation[turn] = forbidden;
  }
}

}  // namespace counterflex
