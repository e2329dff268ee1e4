#include "start_cell.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "counterflex/geometry/rotation.hpp"

namespace counterflex::kernel {
namespace {

/// A place at which a cell's question is solved.
struct Sample {
  Vector3 p;
  Vector3 turn = Vector3::Zero();
  Vector6 F = Vector6::Zero();
};

/// Two samples on either side of the centre, and the size of what changes between each of them and the centre.
struct Difference {
  int forth, back;
  double size;
};

/// The centre, places on the axes and in the planes of two of them, then, at the centre, turned tips and
/// loads.
struct Samples {
  std::vector<Sample> all;
  std::vector<Difference> single;  ///< terms of the orientation and of the load
  double step;
};

constexpr int first_on_axes = 1, first_in_planes = 7;
constexpr double turn_step = 1e-3;  // rad

/// A load of the size under which machines yield by some micrometres.
Vector6 unit_load(int component, double length) {
  constexpr double force = 100;  // N
  return (component < 3 ? force : force * length) * Vector6::Unit(component);
}

Samples samples_about(const CellPlace& place, bool loaded, double length) {
  Samples samples{{{place.centre}}, {}, place.step};
  const auto add = [&](const Vector3& way) { samples.all.push_back({place.centre + place.step * way}); };
  for (int i = 0; i < 3; ++i)
    for (const double sign : {1.0, -1.0}) add(sign * Vector3::Unit(i));
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
    for (const double a : {1.0, -1.0})
      for (const double b : {1.0, -1.0}) add(a * Vector3::Unit(i) + b * Vector3::Unit(j));
  const auto add_pair = [&](const Vector3& turn, const Vector6& F, double size) {
    const int forth = static_cast<int>(samples.all.size());
    samples.single.push_back({forth, forth + 1, size});
    samples.all.push_back({place.centre, turn, F});
    samples.all.push_back({place.centre, -turn, -F});
  };
  for (int i = 0; i < 3 && place.turns; ++i) add_pair(turn_step * Vector3::Unit(i), Vector6::Zero(), turn_step);
  for (int i = 0; i < 6 && loaded; ++i)
    add_pair(Vector3::Zero(), unit_load(i, length), unit_load(i, length)[i]);
  return samples;
}

Pose pose_at(const double* numbers) {
  Pose X;
  for (int i = 0; i < 9; ++i) X.R(i / 3, i % 3) = numbers[i];
  for (int i = 0; i < 3; ++i) X.p[i] = numbers[9 + i];
  return X;
}

/// What leads from one state to another: joints, then for each frame its way and its rotation vector.
Eigen::VectorXd between(const FlatMachine& machine, const double* from, const double* to) {
  Eigen::VectorXd d(machine.unknowns());
  for (int j = 0; j < machine.joints; ++j) d[j] = to[j] - from[j];
  for (int i = 0; i <= machine.nodes; ++i) {
    const int frame = machine.joints + 12 * i;
    d.segment<6>(machine.joints + 6 * i) = difference(pose_at(to + frame), pose_at(from + frame));
  }
  return d;
}

/// Solutions of the samples.
struct Solutions {
  std::vector<double> states, stress, pivots, commands;
};

/// Inputs of a batch that has the samples.
struct SampleBatch {
  std::vector<double> p, R, F;
  std::vector<unsigned char> accepted;
  Batch batch;

  SampleBatch(const std::vector<Sample>& samples, const Matrix3& R_home) : accepted(samples.size()) {
    for (const Sample& sample : samples) {
      p.insert(p.end(), sample.p.begin(), sample.p.end());
      F.insert(F.end(), sample.F.begin(), sample.F.end());
      const Matrix3 turned = counterflex::exp_so3(sample.turn) * R_home;
      for (int i = 0; i < 9; ++i) R.push_back(turned(i / 3, i % 3));
    }
    batch.count = static_cast<int>(samples.size());
    batch.p = p.data(), batch.R = R.data(), batch.F = F.data(), batch.accepted = accepted.data();
  }
  SampleBatch(const SampleBatch&) = delete;

};

std::optional<Solutions> solve_samples(const FlatMachine& machine, const Problem& problem, const Matrix3& R_home,
                                       const std::vector<Sample>& samples, const std::vector<double>& start) {
  SampleBatch of_samples(samples, R_home);
  Solutions solutions;
  solutions.states.resize(static_cast<std::size_t>(machine.state_size()) * samples.size());
  solutions.stress.resize(6 * machine.elements.size() * samples.size());
  solutions.pivots.resize(static_cast<std::size_t>(machine.pivots()) * samples.size());
  solutions.commands.resize(12 * samples.size());
  Batch& batch = of_samples.batch;
  batch.start = start.data(), batch.state = solutions.states.data(), batch.stress = solutions.stress.data();
  batch.nominal_tip = solutions.commands.data();
  if (problem.real) batch.pivots = solutions.pivots.data();
  instance_for(samples.size()).solve(machine, problem, {}, batch);
  for (const unsigned char accepted : of_samples.accepted)
    if (accepted == 0) return std::nullopt;
  return solutions;
}

/// Coefficients of `rows` values, from their differences to the centre's at the samples.
template <class Way>  // Eigen::VectorXd(int sample), from the centre
std::vector<double> changes_of(Eigen::Index rows, const Samples& samples, const Way& way_to) {
  const auto singles = static_cast<int>(samples.single.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> changes(
      rows, StartCell::position_terms + singles);
  const double step = samples.step;
  for (int i = 0; i < 3; ++i) {
    const Eigen::VectorXd forth = way_to(first_on_axes + 2 * i), back = way_to(first_on_axes + 1 + 2 * i);
    changes.col(i) = (forth - back) / (2 * step);
    changes.col(3 + i) = (forth + back) / (2 * step * step);
  }
  for (int k = 0; k < 3; ++k) {
    const int first = first_in_planes + 4 * k;
    changes.col(6 + k) =
        (way_to(first) - way_to(first + 1) - way_to(first + 2) + way_to(first + 3)) / (4 * step * step);
  }
  for (int k = 0; k < singles; ++k) {
    const Difference& d = at(samples.single, k);
    changes.col(StartCell::position_terms + k) = (way_to(d.forth) - way_to(d.back)) / (2 * d.size);
  }
  return {changes.data(), changes.data() + changes.size()};
}

void add_stress(const FlatMachine& machine, const Samples& samples, const std::vector<double>& stress,
                StartCell& cell) {
  const std::size_t size = 6 * machine.elements.size();
  const auto loads = std::span(samples.single).last(StartCell::load_terms);
  for (std::size_t i = 0; i < size; ++i) {
    cell.stress.push_back(stress[i]);
    for (const Difference& d : loads) {
      const double forth = stress[static_cast<std::size_t>(d.forth) * size + i];
      cell.stress.push_back((forth - stress[static_cast<std::size_t>(d.back) * size + i]) / (2 * d.size));
    }
  }
}

/// State and changes of a cell at its centre.
StartCell cell_of(const FlatMachine& machine, const CellPlace& place, const Samples& samples,
                  const Solutions& solutions) {
  StartCell cell;
  const auto size = static_cast<std::ptrdiff_t>(machine.state_size());
  cell.turns = place.turns;
  for (int i = 0; i < 3; ++i) at(cell.centre, i) = place.centre[i];
  cell.state.assign(solutions.states.begin(), solutions.states.begin() + size);
  for (int j = 0; j < machine.joints; ++j) {
    cell.cosine.push_back(std::cos(at(cell.state, j)));
    cell.sine.push_back(std::sin(at(cell.state, j)));
  }
  const double* const states = solutions.states.data();
  const auto way_to = [&](int sample) { return between(machine, states, states + sample * size); };
  cell.changes = changes_of(machine.unknowns(), samples, way_to);
  return cell;
}

void add_offsets(const CellPlace& place, const Samples& samples, const Solutions& solutions, StartCell& cell) {
  const auto offset = [&](int i) -> Eigen::VectorXd {
    const Sample& sample = at(samples.all, i);
    const Pose command = pose_at(solutions.commands.data() + 12 * i);
    const Matrix3 R_tip = counterflex::exp_so3(sample.turn) * place.R_home;
    Vector6 way;
    way << command.p - sample.p, counterflex::log_so3(Matrix3(command.R * R_tip.transpose()));
    return way;
  };
  const Eigen::VectorXd at_centre = offset(0);
  for (int i = 0; i < 6; ++i) at(cell.offset, i) = at_centre[i];
  cell.offset_changes =
      changes_of(6, samples, [&](int sample) -> Eigen::VectorXd { return offset(sample) - at_centre; });
}

}  // namespace

std::optional<StartCell> make_kinematics_cell(const FlatMachine& machine,
                                              const std::vector<Transform>& perfect, const CellPlace& place,
                                              const std::vector<double>& start) {
  const Samples samples = samples_about(place, false, machine.length);
  const Problem kinematics{.real = {}, .nominal = nominal_question(perfect)};
  const auto solutions = solve_samples(machine, kinematics, place.R_home, samples.all, start);
  if (!solutions) return std::nullopt;
  return cell_of(machine, place, samples, *solutions);
}

std::optional<StartCell> make_target_cell(const FlatMachine& machine, const Question& real,
                                          const std::vector<Transform>& perfect, const CellPlace& place,
                                          const StartCell& kinematics) {
  const Samples samples = samples_about(place, true, machine.length);
  const Problem target{.real = real, .nominal = nominal_question(perfect)};
  const auto solutions = solve_samples(machine, target, place.R_home, samples.all, kinematics.state);
  if (!solutions) return std::nullopt;
  StartCell cell = cell_of(machine, place, samples, *solutions);
  cell.loads = true;
  add_stress(machine, samples, solutions->stress, cell);
  cell.pivots.assign(solutions->pivots.begin(), solutions->pivots.begin() + machine.pivots());
  add_offsets(place, samples, *solutions, cell);
  return cell;
}

Vector6 command_offset(const StartCell& cell, const Vector3& p, const Vector3& turn, const Vector6& F) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, StartCell::most_terms, 1> x(cell.terms());
  const Vector3 d = p - Vector3(cell.centre[0], cell.centre[1], cell.centre[2]);
  x.head<StartCell::position_terms>() << d, d.cwiseProduct(d), d[0] * d[1], d[0] * d[2], d[1] * d[2];
  if (cell.turns) x.segment<3>(StartCell::position_terms) = turn;
  x.tail<6>() = F;
  using Changes = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  return Vector6(cell.offset.data()) + Eigen::Map<const Changes>(cell.offset_changes.data(), 6, cell.terms()) * x;
}

}  // namespace counterflex::kernel
