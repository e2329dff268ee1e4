#include "start_cell.hpp"

#include "counterflex/geometry/rotation.hpp"

namespace counterflex::kernel {
namespace {

/// The places at which differences are taken: on the axes, then in the planes of two of them.
std::vector<Vector3> places_about(const Vector3& centre, double step) {
  std::vector<Vector3> places{centre};
  for (int i = 0; i < 3; ++i)
    for (const double sign : {1.0, -1.0}) places.push_back(centre + sign * step * Vector3::Unit(i));
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
    for (const double a : {1.0, -1.0})
      for (const double b : {1.0, -1.0})
        places.push_back(centre + step * (a * Vector3::Unit(i) + b * Vector3::Unit(j)));
  return places;
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

}  // namespace

std::optional<StartCell> make_start_cell(const Model& model, const Flat& flat,
                                         const std::vector<Transform>& perfect, const Vector3& centre,
                                         double step) {
  const FlatMachine& machine = flat.machine;
  const Matrix3 R = tip(model.mechanism, model.home).R;
  const NominalResult nominal = follow(model, model.home, {R, centre});
  if (nominal.status != Status::converged) return std::nullopt;
  const std::vector<double> start = state_of(model, flat, nominal.configuration, 0);
  const std::vector<Vector3> places = places_about(centre, step);
  const auto size = static_cast<std::size_t>(machine.state_size());
  std::vector<double> p, rotations, F(6 * places.size(), 0), states(size * places.size());
  for (const Vector3& place : places) {
    p.insert(p.end(), place.begin(), place.end());
    for (int i = 0; i < 9; ++i) rotations.push_back(R(i / 3, i % 3));
  }
  std::vector<unsigned char> accepted(places.size());
  Batch batch;
  batch.count = static_cast<int>(places.size());
  batch.p = p.data(), batch.R = rotations.data(), batch.F = F.data(), batch.start = start.data();
  batch.accepted = accepted.data(), batch.state = states.data();
  scalar_instance.solve(machine, nominal_question(perfect, true), {}, batch);
  for (const unsigned char is_accepted : accepted)
    if (is_accepted == 0) return std::nullopt;

  StartCell cell;
  for (int i = 0; i < 3; ++i) at(cell.centre, i) = centre[i];
  cell.state.assign(states.begin(), states.begin() + static_cast<std::ptrdiff_t>(size));
  for (int j = 0; j < machine.joints; ++j) {
    cell.cosine.push_back(std::cos(at(cell.state, j)));
    cell.sine.push_back(std::sin(at(cell.state, j)));
  }
  const auto way_to = [&](int place) {
    return between(machine, states.data(), states.data() + static_cast<std::size_t>(place) * size);
  };
  Eigen::Matrix<double, Eigen::Dynamic, StartCell::terms, Eigen::RowMajor> taylor(machine.unknowns(),
                                                                                  StartCell::terms);
  for (int i = 0; i < 3; ++i) {
    const Eigen::VectorXd forth = way_to(1 + 2 * i), back = way_to(2 + 2 * i);
    taylor.col(i) = (forth - back) / (2 * step);
    taylor.col(3 + i) = (forth + back) / (2 * step * step);
  }
  for (int k = 0; k < 3; ++k) {
    const int first = 7 + 4 * k;
    taylor.col(6 + k) =
        (way_to(first) - way_to(first + 1) - way_to(first + 2) + way_to(first + 3)) / (4 * step * step);
  }
  cell.taylor.assign(taylor.data(), taylor.data() + taylor.size());
  return cell;
}

}  // namespace counterflex::kernel
