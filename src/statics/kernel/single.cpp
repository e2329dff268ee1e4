#include "statics/kernel/single.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statics/kernel/solve_batch.hpp"

namespace counterflex::kernel {
namespace {

constexpr double unknown_contraction = std::numeric_limits<double>::infinity();

Vec6<double> vec6(const double* x) {
  return {{{x[0], x[1], x[2]}}, {{x[3], x[4], x[5]}}};
}

bool turns_are_in_range(const Work<double>& work) {
  return work.equations.largest_turn_squared <= largest_spring_turn * largest_spring_turn;
}

}  // namespace

struct Single::Impl {
  Flat flat;
  Problem problem{.real = Question{.machine = &flat.machine}, .nominal = {}};
  Coupled<double> coupled;
  std::vector<Transform> transforms;  // with this share of the errors
  double errors = -1;
  std::vector<double> rests;  // by step, preloads acting
  StateNumbers numbers;

  explicit Impl(const Mechanism& mechanism) : flat(flatten(mechanism, false)), coupled(problem) {
    for (const FrameStep& step : flat.machine.steps) rests.push_back(step.rest);
  }

  Work<double>& work() { return coupled.real; }

  bool is_able(const Waypoint& waypoint) const {
    const auto& controlled = flat.machine.controlled;
    return flat.is_solvable &&
           (!waypoint.X_MT || std::any_of(controlled.begin(), controlled.end(), [](bool c) { return c; }));
  }

  void put(const Mechanism& mechanism, const Waypoint& waypoint, const Configuration& start) {
    FlatMachine& machine = flat.machine;
    const Stage& stage = waypoint.stage;
    if (errors != stage.errors) {
      transforms = transforms_at(flat, stage.errors);
      errors = stage.errors;
    }
    const Vector3 arm = waypoint.load.at_platform ? mechanism.p_EP : mechanism.X_PT.p;
    for (int i = 0; i < 3; ++i) at(machine.p_arm, i) = arm[i];
    read_state(mechanism, flat, start, stage, numbers);
    put_rests(stage.preload);
    Work<double>& w = work();
    w.question = {.machine = &machine,
                  .transforms = &transforms,
                  .load = stage.load,
                  .preload = stage.preload,
                  .gravity = stage.gravity,
                  .errors = stage.errors};
    coupled.begin({.real = true, .moves_actuators = waypoint.X_MT != nullptr});
    w.load = vec6(waypoint.load.F.data());
    const Pose X_MT = waypoint.X_MT ? *waypoint.X_MT : start.X_MP * mechanism.X_PT;
    for (int i = 0; i < 3; ++i) w.origin[i] = X_MT.p[i];
    for (int i = 0; i < 9; ++i) w.wanted_R.c[i] = X_MT.R(i / 3, i % 3);
    put_state(machine, 0, numbers.state.data(), w);
    for (std::size_t i = 0; i < machine.elements.size(); ++i)
      w.start_stress[i] = vec6(numbers.stress.data() + 6 * i);
  }

  // Passive springs are relaxed in the nominal configuration, as far as preloads do not act.
  void put_rests(double preload) {
    for (std::size_t i = 0; i < rests.size(); ++i) {
      FrameStep& step = flat.machine.steps[i];
      if (!step.passive) continue;
      const double nominal = at(numbers.nominal, step.joint);
      step.rest = nominal + preload * (rests[i] - nominal);
    }
  }

  // What the linear step adds to the wrench on the end of a series.
  Vec6<double> correction(int s) {
    const Series& series = at(flat.machine.series, s);
    const int last = series.first + series.count - 1;
    const Element& element = at(flat.machine.elements, last);
    const ElementTerms<double>& terms = at(work().equations.elements, last);
    if (element.kind == ElementKind::spring) return terms.stress - terms.phi;
    Vec6<double> sum{};
    for (int b = 0; b < element.branches; ++b) sum = sum + correction(element.series + b);
    return sum;
  }

  void get(const Mechanism& mechanism, const Stage& stage, Configuration& configuration) {
    get_state(0, work(), numbers.state.data());
    numbers.ends.clear();
    for (std::size_t s = 0; s < flat.machine.series.size(); ++s) {
      const Vec6<double> end = work().equations.ends[s] + correction(static_cast<int>(s));
      for (int i = 0; i < 6; ++i) numbers.ends.push_back(end[i]);
    }
    write_state(mechanism, flat, numbers, Vector3(work().origin[0], work().origin[1], work().origin[2]),
                stage, configuration);
  }

  // A step by the tangent at the solution. Stress that follows from frames has their rounding errors times
  // the stiffness; that of the linear step is in balance.
  void polish() {
    Work<double>& w = work();
    factor_at_solution(coupled);
    w.predicts_stress = true;
    find_step(coupled);
    take_step<double>(true, w);
  }

  // A displacement of all unknowns by about a millionth of l.
  void displace() {
    const FlatMachine& machine = flat.machine;
    Work<double>& w = work();
    int i = 0;
    const auto next = [&] { return test_displacement * std::sin(++i); };
    const auto twist = [&] {
      Vec6<double> xi;
      for (int k = 0; k < 6; ++k) xi[k] = next() * (k < 3 ? machine.length : 1);
      return xi;
    };
    for (int j = 0; j < machine.joints; ++j) {
      const double dq = next() * (at(machine.joint_turns, j) != 0 ? 1 : machine.length);
      at(w.equations.joints, j).y = actuator_of(machine, j) < 0 ? dq : 0;
    }
    for (Vec6<double>& node : w.step.nodes) node = twist();
    w.step.platform = twist();
    w.step.turn = test_displacement;
    take_step<double>(true, w);
  }

  // Whether steps by the last factors, actuators held, take a displacement away by far. With A the tangent
  // and E what it leaves out, they leave -A^-1 E of it; where that contracts, A + E has the inertia of A.
  bool contracts() {
    Work<double>& w = work();
    displace();
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
      evaluate(w);
      find_held_step(w);
      find_inner_steps(w);
      take_step<double>(true, w);
      if (w.step.size <= step_tolerance) return true;
      if (!(w.step.size < judging_contraction * last)) return false;
      last = w.step.size;
    }
    return true;
  }

  void note_first_step(SingleAnswer& answer) {
    const Frame<double>& X = work().state.platform;
    for (int i = 0; i < 9; ++i) answer.first_X_MP.R(i / 3, i % 3) = X.R.c[i];
    for (int i = 0; i < 3; ++i) answer.first_X_MP.p[i] = X.p[i] + work().origin[i];
    answer.first_rho.resize(static_cast<Eigen::Index>(flat.machine.actuator_joint.size()));
    for (int a = 0; a < static_cast<int>(answer.first_rho.size()); ++a)
      answer.first_rho[a] = get_actuator(a, 0, work());
  }
};

Single::Single(const Mechanism& mechanism) : impl_(std::make_unique<Impl>(mechanism)) {}
Single::~Single() = default;
Single::Single(Single&&) noexcept = default;

SingleAnswer Single::solve(const Mechanism& mechanism, const Waypoint& waypoint,
                           Configuration& configuration) {
  SingleAnswer answer;
  if (!impl_->is_able(waypoint)) return answer;
  impl_->put(mechanism, waypoint, configuration);
  int tangents = 0;
  bool in_range = true;
  const auto at_tangent = [&](bool) {
    in_range = in_range && turns_are_in_range(impl_->work());
    if (++tangents == 2) impl_->note_first_step(answer);
  };
  const Solved<double> solved = iterate<double>({.first = FirstStress::of_cells}, true, unknown_contraction,
                                                impl_->coupled, at_tangent);
  answer.accepted = solved.accepted && in_range;
  answer.iterations = static_cast<int>(solved.iterations);
  if (!answer.accepted) return answer;
  if (tangents < 2) impl_->note_first_step(answer);
  impl_->polish();
  impl_->get(mechanism, waypoint.stage, configuration);
  return answer;
}

std::optional<PivotRange> Single::pivots(const Mechanism& mechanism, const Waypoint& waypoint,
                                         const Configuration& configuration) {
  const FlatMachine& machine = impl_->flat.machine;
  if (!impl_->flat.is_solvable) return std::nullopt;
  impl_->put(mechanism, {waypoint.load, waypoint.stage}, configuration);
  Work<double>& work = impl_->work();
  evaluate(work);
  factor_at_solution(impl_->coupled);
  PivotRange range{std::numeric_limits<double>::infinity(), 0, -6 * machine.rigid_closures};
  visit_pivots(work, [&](int i, double inverse) {
    const bool joint = i < machine.joints,
               turns = joint ? at(machine.joint_turns, i) != 0 : (i - machine.joints) % 6 >= 3;
    if (joint && actuator_of(machine, i) >= 0) return;
    const double pivot = inverse == 0 ? 0 : 1 / inverse;
    const double size =
        std::min(stiff_enough, std::abs(pivot) / (turns ? machine.length * machine.length : 1));
    range.least = std::min(range.least, size);
    range.largest = std::max(range.largest, size);
    range.unstable_directions += pivot < 0;
  });
  if (machine.has_hanging_weights && waypoint.stage.gravity != 0 && !impl_->contracts()) return std::nullopt;
  return range;
}

}  // namespace counterflex::kernel
