#include "start_cell.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/rotation.hpp"

namespace counterflex::kernel {
namespace {

/// Where differences are taken: at the centre, on the axes, in the planes of two of them, and, where a load
/// acts, at the centre under six loads forth and back.
struct Sample {
  Vector3 p;
  Vector6 F = Vector6::Zero();
};

constexpr int first_on_axes = 1, first_in_planes = 7, first_loaded = 19;

/// A load of the size under which machines yield by some micrometres.
Vector6 unit_load(int component, double length) {
  constexpr double force = 100;  // N
  return (component < 3 ? force : force * length) * Vector6::Unit(component);
}

std::vector<Sample> samples_about(const Vector3& centre, double step, bool loaded, double length) {
  std::vector<Sample> samples{{centre}};
  for (int i = 0; i < 3; ++i)
    for (const double sign : {1.0, -1.0}) samples.push_back({centre + sign * step * Vector3::Unit(i)});
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
    for (const double a : {1.0, -1.0})
      for (const double b : {1.0, -1.0})
        samples.push_back({centre + step * (a * Vector3::Unit(i) + b * Vector3::Unit(j))});
  for (int k = 0; k < 6 && loaded; ++k)
    for (const double sign : {1.0, -1.0}) samples.push_back({centre, sign * unit_load(k, length)});
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
  std::vector<double> states, stress, actuators, pivots;
};

/// Inputs of a batch that has the samples.
struct SampleBatch {
  std::vector<double> p, R, F;
  std::vector<unsigned char> accepted;
  Batch batch;

  SampleBatch(const std::vector<Sample>& samples, const Matrix3& orientation) : accepted(samples.size()) {
    for (const Sample& sample : samples) {
      p.insert(p.end(), sample.p.begin(), sample.p.end());
      F.insert(F.end(), sample.F.begin(), sample.F.end());
      for (int i = 0; i < 9; ++i) R.push_back(orientation(i / 3, i % 3));
    }
    batch.count = static_cast<int>(samples.size());
    batch.p = p.data(), batch.R = R.data(), batch.F = F.data(), batch.accepted = accepted.data();
  }
  SampleBatch(const SampleBatch&) = delete;

  bool solve(const FlatMachine& machine, const Question& question) {
    scalar_instance.solve(machine, question, {}, batch);
    return std::all_of(accepted.begin(), accepted.end(), [](unsigned char a) { return a != 0; });
  }
};

std::optional<Solutions> solve_samples(const FlatMachine& machine, const Question& question, const Matrix3& R,
                                       const std::vector<Sample>& samples, const std::vector<double>& start) {
  SampleBatch of_samples(samples, R);
  Solutions solutions;
  solutions.states.resize(static_cast<std::size_t>(machine.state_size()) * samples.size());
  solutions.stress.resize(6 * machine.elements.size() * samples.size());
  solutions.actuators.resize(machine.actuator_joint.size() * samples.size());
  solutions.pivots.resize(static_cast<std::size_t>(machine.pivots()) * samples.size());
  Batch& batch = of_samples.batch;
  batch.start = start.data(), batch.state = solutions.states.data(), batch.stress = solutions.stress.data();
  batch.actuators = solutions.actuators.data(), batch.pivots = solutions.pivots.data();
  if (!of_samples.solve(machine, question)) return std::nullopt;
  return solutions;
}

/// Coefficients of `rows` values, `terms` each, from their differences to the centre's at the samples.
template <class Way>  // Eigen::VectorXd(int sample), from the centre
std::vector<double> changes_of(Eigen::Index rows, const Way& way_to, double step, double length, int terms) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> changes(rows, terms);
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
  for (int k = 0; StartCell::place_terms + k < terms; ++k)
    changes.col(StartCell::place_terms + k) =
        (way_to(first_loaded + 2 * k) - way_to(first_loaded + 1 + 2 * k)) / (2 * unit_load(k, length)[k]);
  return {changes.data(), changes.data() + changes.size()};
}

void add_stress(const FlatMachine& machine, const std::vector<double>& stress, StartCell& cell) {
  const std::size_t size = 6 * machine.elements.size();
  for (std::size_t i = 0; i < size; ++i) {
    cell.stress.push_back(stress[i]);
    for (int k = 0; k < 6; ++k) {
      const auto forth = static_cast<std::size_t>(first_loaded + 2 * k);
      const double change = stress[forth * size + i] - stress[(forth + 1) * size + i];
      cell.stress.push_back(change / (2 * unit_load(k, machine.length)[k]));
    }
  }
}

/// State and changes of a cell at its centre.
StartCell cell_of(const FlatMachine& machine, const CellPlace& place, const Solutions& solutions, int terms) {
  StartCell cell;
  const auto size = static_cast<std::ptrdiff_t>(machine.state_size());
  for (int i = 0; i < 3; ++i) at(cell.centre, i) = place.centre[i];
  cell.state.assign(solutions.states.begin(), solutions.states.begin() + size);
  for (int j = 0; j < machine.joints; ++j) {
    cell.cosine.push_back(std::cos(at(cell.state, j)));
    cell.sine.push_back(std::sin(at(cell.state, j)));
  }
  cell.terms = terms;
  const double* const states = solutions.states.data();
  const auto way_to = [&](int sample) { return between(machine, states, states + sample * size); };
  cell.changes = changes_of(machine.unknowns(), way_to, place.step, machine.length, terms);
  return cell;
}

/// The command that belongs to the solution of each sample, from the wanted tip.
bool add_offsets(const FlatMachine& machine, const std::vector<Transform>& perfect, const CellPlace& place,
                 const std::vector<Sample>& samples, const Solutions& solutions, const StartCell& kinematics,
                 StartCell& cell) {
  SampleBatch of_samples(samples, place.R);
  std::vector<const StartCell*> cells(samples.size(), &kinematics);
  std::vector<double> tips(12 * samples.size());
  Batch& batch = of_samples.batch;
  batch.rho = solutions.actuators.data(), batch.cells = cells.data(), batch.tip = tips.data();
  if (!of_samples.solve(machine, nominal_question(perfect, false))) return false;
  const auto offset = [&](int sample) -> Eigen::VectorXd {
    const auto s = static_cast<std::size_t>(sample);
    return pose_at(tips.data() + 12 * s).p - samples[s].p;
  };
  const Eigen::VectorXd at_centre = offset(0);
  for (int i = 0; i < 3; ++i) at(cell.offset, i) = at_centre[i];
  const auto way_to = [&](int sample) -> Eigen::VectorXd { return offset(sample) - at_centre; };
  cell.offset_changes = changes_of(3, way_to, place.step, machine.length, StartCell::all_terms);
  return true;
}

}  // namespace

std::optional<StartCell> make_kinematics_cell(const FlatMachine& machine,
                                              const std::vector<Transform>& perfect, const CellPlace& place,
                                              const std::vector<double>& start) {
  const auto samples = samples_about(place.centre, place.step, false, machine.length);
  const auto solutions = solve_samples(machine, nominal_question(perfect, true), place.R, samples, start);
  if (!solutions) return std::nullopt;
  return cell_of(machine, place, *solutions, StartCell::place_terms);
}

std::optional<StartCell> make_target_cell(const FlatMachine& machine, const Question& question,
                                          const std::vector<Transform>& perfect, const CellPlace& place,
                                          const StartCell& kinematics) {
  const auto samples = samples_about(place.centre, place.step, true, machine.length);
  const auto solutions = solve_samples(machine, question, place.R, samples, kinematics.state);
  if (!solutions) return std::nullopt;
  StartCell cell = cell_of(machine, place, *solutions, StartCell::all_terms);
  add_stress(machine, solutions->stress, cell);
  cell.pivots.assign(solutions->pivots.begin(), solutions->pivots.begin() + machine.pivots());
  if (!add_offsets(machine, perfect, place, samples, *solutions, kinematics, cell)) return std::nullopt;
  return cell;
}

Vector3 command_offset(const StartCell& cell, const Vector3& p, const Vector6& F) {
  Eigen::Matrix<double, StartCell::all_terms, 1> x;
  const Vector3 d = p - Vector3(cell.centre[0], cell.centre[1], cell.centre[2]);
  x << d, d.cwiseProduct(d), d[0] * d[1], d[0] * d[2], d[1] * d[2], F;
  Vector3 offset(cell.offset[0], cell.offset[1], cell.offset[2]);
  for (int i = 0; i < 3; ++i)
    offset[i] += x.dot(Eigen::Map<const Eigen::Matrix<double, StartCell::all_terms, 1>>(
        cell.offset_changes.data() + StartCell::all_terms * i));
  return offset;
}

}  // namespace counterflex::kernel
