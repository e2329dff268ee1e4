#include "start_cell.hpp"

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

/// Solutions of the samples; none where one of them is not accepted.
struct Solutions {
  std::vector<double> states, stress;
};
std::optional<Solutions> solve_samples(const FlatMachine& machine, const Question& question, const Matrix3& R,
                                       const std::vector<Sample>& samples, const std::vector<double>& start) {
  std::vector<double> p, rotations, F;
  for (const Sample& sample : samples) {
    p.insert(p.end(), sample.p.begin(), sample.p.end());
    F.insert(F.end(), sample.F.begin(), sample.F.end());
    for (int i = 0; i < 9; ++i) rotations.push_back(R(i / 3, i % 3));
  }
  Solutions solutions;
  solutions.states.resize(static_cast<std::size_t>(machine.state_size()) * samples.size());
  solutions.stress.resize(6 * machine.elements.size() * samples.size());
  std::vector<unsigned char> accepted(samples.size());
  Batch batch;
  batch.count = static_cast<int>(samples.size());
  batch.p = p.data(), batch.R = rotations.data(), batch.F = F.data(), batch.start = start.data();
  batch.accepted = accepted.data(), batch.state = solutions.states.data(),
  batch.stress = solutions.stress.data();
  scalar_instance.solve(machine, question, {}, batch);
  for (const unsigned char is_accepted : accepted)
    if (is_accepted == 0) return std::nullopt;
  return solutions;
}

template <class Way>  // Eigen::VectorXd(int sample), from the centre
void add_changes(const FlatMachine& machine, const Way& way_to, double step, StartCell& cell) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> changes(machine.unknowns(),
                                                                                 cell.terms);
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
  for (int k = 0; StartCell::place_terms + k < cell.terms; ++k)
    changes.col(StartCell::place_terms + k) =
        (way_to(first_loaded + 2 * k) - way_to(first_loaded + 1 + 2 * k)) /
        (2 * unit_load(k, machine.length)[k]);
  cell.changes.assign(changes.data(), changes.data() + changes.size());
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

}  // namespace

std::optional<StartCell> make_start_cell(const Model& model, const Flat& flat, const Question& question,
                                         const Vector3& centre, double step) {
  const FlatMachine& machine = flat.machine;
  const Matrix3 R = tip(model.mechanism, model.home).R;
  const NominalResult nominal = follow(model, model.home, {R, centre});
  if (nominal.status != Status::converged) return std::nullopt;
  const std::vector<double> start = state_of(model, flat, nominal.configuration, 0);
  const bool loaded = question.load != 0;
  const auto solutions =
      solve_samples(machine, question, R, samples_about(centre, step, loaded, machine.length), start);
  if (!solutions) return std::nullopt;

  StartCell cell;
  const auto size = static_cast<std::ptrdiff_t>(machine.state_size());
  for (int i = 0; i < 3; ++i) at(cell.centre, i) = centre[i];
  cell.state.assign(solutions->states.begin(), solutions->states.begin() + size);
  for (int j = 0; j < machine.joints; ++j) {
    cell.cosine.push_back(std::cos(at(cell.state, j)));
    cell.sine.push_back(std::sin(at(cell.state, j)));
  }
  cell.terms = loaded ? StartCell::all_terms : StartCell::place_terms;
  const double* const states = solutions->states.data();
  add_changes(
      machine, [&](int sample) { return between(machine, states, states + sample * size); }, step, cell);
  if (loaded) add_stress(machine, solutions->stress, cell);
  return cell;
}

}  // namespace counterflex::kernel
