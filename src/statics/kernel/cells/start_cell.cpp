#include "statics/kernel/cells/start_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/cells/offset_bounds.hpp"
#include "statics/kernel/machine/states.hpp"

namespace counterflex::kernel {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

/// A place at which a cell's question is solved.
struct Sample {
  Vector3 p;
  Vector3 turn = Vector3::Zero();
  Vector6 F = Vector6::Zero();
};

/// The centre, then a pair of samples on either side of it for each variable, then the corners.
struct Samples {
  std::vector<Sample> all;
  std::vector<double> steps;  ///< by variable
};

Vector6 unit_loads(double length) {
  Vector6 F;
  F << Vector3::Constant(load_of_cells), Vector3::Constant(load_of_cells * length);
  return F;
}

constexpr int corners_of_cube = 8;

Vector3 signs_of(int corner) {
  return {corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
}

Samples samples_about(const CellPlace& place, const Variables& variables, double length) {
  Samples samples{{{place.centre}}, {}};
  for (int k = 0; k < variables.count(); ++k) {
    const int load = k - variables.first_load();
    const double step = load >= 0 ? unit_loads(length)[load] : k < 3 ? place.step : turn_edge / 2;
    samples.steps.push_back(step);
    for (const double way : {step, -step}) {
      Sample sample{place.centre};
      (load >= 0 ? sample.F[load] : k < 3 ? sample.p[k] : sample.turn[k - 3]) += way;
      samples.all.push_back(sample);
    }
  }
  for (int k = 0; k < corners_of_cube; ++k) samples.all.push_back({place.centre + place.step * signs_of(k)});
  return samples;
}

Acting acting_in(const Vector6& F) {
  return !F.tail<3>().isZero(0) ? Acting::moment : !F.head<3>().isZero(0) ? Acting::force : Acting::nothing;
}

/// The corners of a cell, each with another load of one size: along one component, in all components of the
/// force, or in all of them. Then the same corners without a load.
std::vector<Sample> corners_about(const CellPlace& place, double length) {
  std::vector<Sample> corners;
  for (int k = 0; k < corners_of_cube; ++k) {
    const Vector3 signs = signs_of(k);
    Vector6 F = Vector6::Constant(std::sqrt(1.0 / 6));
    if (k < 6) F = Vector6::Unit(k);
    if (k == 6) F << Vector3::Constant(std::sqrt(1.0 / 3)), Vector3::Zero();
    F.head<3>() = F.head<3>().cwiseProduct(signs);
    F.tail<3>() *= k % 2 == 0 ? length : -length;
    corners.push_back({place.centre + place.step * signs, Vector3::Zero(), load_of_cells * F});
  }
  for (int k = 0; k < corners_of_cube; ++k) corners.push_back({at(corners, k).p});
  return corners;
}

/// The solutions of samples, from what `batch` has: states or cells in which they begin, and the variables of
/// responses. None where a sample is not solved.
std::optional<Batch> solve_samples(const Problem& problem, const CellPlace& place,
                                   const std::vector<Sample>& samples, Batch batch) {
  for (const Sample& sample : samples) {
    batch.p.insert(batch.p.end(), sample.p.begin(), sample.p.end());
    batch.F.insert(batch.F.end(), sample.F.begin(), sample.F.end());
    const Matrix3 turned = counterflex::exp_so3(sample.turn) * place.R;
    for (int i = 0; i < 9; ++i) batch.R.push_back(turned(i / 3, i % 3));
  }
  batch.wants_states = true, batch.wants_pivots = batch.response_to.has_value();
  Solver().solve(problem, batch.cells.empty() ? Schedule{} : cell_schedule, batch);
  if (std::ranges::count(batch.accepted, 0) > 0) return std::nullopt;
  return batch;
}

/// From twists about the point `c` to changes of a frame's position and of its rotation vector against
/// `centre`.
void to_changes(const Pose& X, const Matrix3& R_centre, const Vector3& c, Eigen::Ref<Rows> twists) {
  const Vector3 turn = counterflex::log_so3(Matrix3(X.R * R_centre.transpose()));
  twists.topRows<3>() -= skew(X.p - c) * twists.bottomRows<3>();
  twists.bottomRows<3>() = (left_jacobian_inverse(turn) * twists.bottomRows<3>()).eval();
}

/// Twists by a rotation of the wanted tip, by its rotation vector.
void by_rotation_vector(const Variables& variables, const Vector3& turn, Rows& twists) {
  if (variables.turns) twists.middleCols<3>(3) = (twists.middleCols<3>(3) * left_jacobian(turn)).eval();
}

/// From the tip of a sample to its command.
Vector6 offset_of(const CellPlace& place, const Sample& sample, const double* command) {
  const Pose X = get_pose(command);
  Vector6 way;
  way << X.p - sample.p,
      counterflex::log_so3(Matrix3(X.R * (counterflex::exp_so3(sample.turn) * place.R).transpose()));
  return way;
}

class CellSamples {
 public:
  CellSamples(const FlatMachine& machine, const CellPlace& place, const Variables& variables,
              const Samples& samples, const Batch& solutions)
      : machine_(machine), place_(place), variables_(variables), samples_(samples), solutions_(solutions) {}

  const double* state(int sample) const { return solutions_.state.data() + machine_.state_size() * sample; }

  Rows state_jacobian(int sample) const {
    Rows J = responses(sample).topRows(machine_.unknowns());
    by_rotation_vector(variables_, at(samples_.all, sample).turn, J);
    for (int i = 0; i <= machine_.nodes; ++i) {
      const int frame = machine_.joints + 12 * i;
      to_changes(get_pose(state(sample) + frame), get_pose(state(0) + frame).R, at(samples_.all, sample).p,
                 J.middleRows(machine_.joints + 6 * i, 6));
    }
    return J;
  }

  Rows offset_jacobian(int sample) const {
    const Sample& of = at(samples_.all, sample);
    const Pose X = get_pose(solutions_.nominal_tip.data() + 12 * sample);
    const Matrix3 R_tip = counterflex::exp_so3(of.turn) * place_.R, E = X.R * R_tip.transpose();
    Rows J = responses(sample).bottomRows(6);
    J.topRows<3>() -= skew(X.p - of.p) * J.bottomRows<3>();
    J.topLeftCorner<3, 3>() -= Matrix3::Identity();
    if (variables_.turns) J.block<3, 3>(3, 3) -= E;
    J.bottomRows<3>() = (left_jacobian_inverse(counterflex::log_so3(E)) * J.bottomRows<3>()).eval();
    by_rotation_vector(variables_, of.turn, J);
    return J;
  }

  /// Stress by element a block: terms of first order, and products of a position and a load.
  Polynomials stress_changes() const {
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(machine_.elements.size());
    const auto stress = [&](int sample) {
      return Eigen::Map<const Eigen::VectorXd>(solutions_.stress.data() + size * sample, size);
    };
    const auto response = [&](int sample, int variable) {
      return Eigen::Map<const Eigen::VectorXd>(
          solutions_.stress_responses.data() + size * (variables_.count() * sample + variable), size);
    };
    Rows changes(size, static_cast<Eigen::Index>(all_terms_.size()));
    std::vector<Term> terms;
    for (const Term& term : all_terms_) {
      const auto [i, j, k] = term.of;
      const int above = 1 + 2 * i, below = 2 + 2 * i;
      if (j == no_variable)
        changes.col(term.number) = stress(above) - stress(below);
      else if (k == no_variable && variables_.is_position(i) && variables_.is_load(j))
        changes.col(term.number) = response(above, j) - response(below, j);
      else
        continue;
      changes.col(term.number) /= 2 * at(samples_.steps, i);
      terms.push_back(term);
    }
    return in_blocks(changes, size, std::move(terms));
  }

  /// The coefficients of all terms, by column, of the rows whose first derivatives at a sample are
  /// `jacobian(sample)`.
  template <class Jacobian>
  Rows expanded(const Jacobian& jacobian) const {
    std::vector<Rows> J;
    for (int sample = 0; sample < static_cast<int>(samples_.all.size()); ++sample)
      J.push_back(jacobian(sample));
    const auto second = [&](int i, int j) -> Eigen::VectorXd {  // of derivative i by variable j
      return (at(J, 1 + 2 * j).col(i) - at(J, 2 + 2 * j).col(i)) / (2 * at(samples_.steps, j));
    };
    Rows coefficients(J[0].rows(), static_cast<Eigen::Index>(all_terms_.size()));
    for (const Term& term : all_terms_) {
      const auto [i, j, k] = term.of;
      auto of_term = coefficients.col(term.number);
      if (j == no_variable)
        of_term = J[0].col(i);
      else if (k == no_variable)
        of_term = (second(i, j) + second(j, i)) / (i == j ? 4 : 2);
      else if (i == j)
        of_term = (at(J, 1 + 2 * i).col(k) + at(J, 2 + 2 * i).col(k) - 2 * J[0].col(k)) /
                  (std::pow(at(samples_.steps, i), 2) * (j == k ? 6 : 2));
      else {
        const int first_corner = 1 + 2 * variables_.count();
        of_term.setZero();
        for (int corner = 0; corner < corners_of_cube; ++corner) {
          const Vector3 signs = signs_of(corner);
          of_term += at(J, first_corner + corner).col(k) * (signs[i] * signs[j]);
        }
        of_term /= corners_of_cube * std::pow(place_.step, 2);
      }
    }
    return coefficients;
  }

  Polynomials all_of(const Rows& coefficients) const {
    return in_blocks(coefficients, coefficients.rows(), all_terms_);
  }

  /// The polynomials of a start: without terms that are negligible everywhere in the cell, and without those
  /// that do not save a step. `units`: what rows are multiplied with to be m.
  Polynomials of_start(const Rows& coefficients, const Eigen::VectorXd& units) const {
    Point<double> extents;
    for (int k = 0; k < variables_.count(); ++k)
      extents[k] = variables_.is_position(k)         ? place_.step
                   : variables_.is_turn(k)           ? turn_edge / 2
                   : k < variables_.first_load() + 3 ? load_of_cells
                                                     : load_of_cells * machine_.length;
    std::vector<Term> terms;
    for (const Term& term : all_terms_) {
      const auto [i, j, k] = term.of;
      if (k != no_variable && variables_.is_turn(k)) continue;
      if (j != no_variable && variables_.is_turn(i) && variables_.is_load(j)) continue;
      const double moves =
          coefficients.col(term.number).cwiseProduct(units).cwiseAbs().maxCoeff() * extents.value_of(term);
      if (moves > negligible_term) terms.push_back(term);
    }
    return in_blocks(coefficients, machine_.joints, std::move(terms));
  }

 private:
  /// The least load under which a term is not zero.
  Acting acting(const Term& term) const {
    Acting most = Acting::nothing;
    for (const int i : term.of)
      if (i != no_variable && variables_.is_load(i))
        most = std::max(most, i < variables_.first_load() + 3 ? Acting::force : Acting::moment);
    return most;
  }

  /// Coefficients in blocks: the first rows are filled up with zeros to whole blocks.
  Polynomials in_blocks(const Rows& coefficients, Eigen::Index first_rows, std::vector<Term> terms) const {
    std::ranges::stable_sort(terms, {}, [&](const Term& term) { return acting(term); });
    const auto until = [&](Acting most) {
      return static_cast<std::size_t>(
          std::ranges::find_if(terms, [&](const Term& term) { return acting(term) > most; }) - terms.begin());
    };
    const std::size_t unloaded = until(Acting::nothing), without_moment = until(Acting::force);
    Polynomials polynomials{std::move(terms), {}, unloaded, without_moment};
    for (Eigen::Index first = 0; first < coefficients.rows();) {
      const Eigen::Index end = first < first_rows ? std::min(first + block, first_rows) : first + block;
      for (const Term& term : polynomials.terms)
        for (Eigen::Index i = first; i < first + block; ++i)
          polynomials.coefficients.push_back(i < end ? coefficients(i, term.number) : 0);
      first = end;
    }
    polynomials.coefficients.shrink_to_fit();  // many cells are kept
    return polynomials;
  }

  Rows responses(int sample) const {
    const Eigen::Index size = machine_.unknowns() + (variables_.loads ? 6 : 0);
    const Eigen::Index n = variables_.count();
    return Eigen::Map<const Rows>(solutions_.responses.data() + size * n * sample, size, n);
  }

  const FlatMachine& machine_;
  const CellPlace& place_;
  const Variables variables_;
  const Samples& samples_;
  const Batch& solutions_;
  const std::vector<Term> all_terms_ = terms_of(variables_);
};

/// What rows of twists are multiplied with to be m.
Eigen::VectorXd units_of_twists(Eigen::Index twists, double length) {
  Vector6 units;
  units << Vector3::Ones(), Vector3::Constant(length);
  return units.replicate(twists, 1);
}

bool only_translates(const Rows& changes, const Variables& variables, double step) {
  for (const Term& term : terms_of(variables)) {
    const auto [i, j, k] = term.of;
    if (k != no_variable || !variables.is_position(i) || !(j == no_variable || variables.is_position(j)))
      continue;
    const double turns = changes.bottomRows<3>().col(term.number).cwiseAbs().maxCoeff();
    if (turns * (j == no_variable ? step : step * step) > step_tolerance) return false;
  }
  return true;
}

/// State and changes of a cell at its centre.
StartCell cell_of(const FlatMachine& machine, const CellPlace& place, const Variables& variables,
                  const CellSamples& samples) {
  StartCell cell;
  cell.variables = variables;
  for (int i = 0; i < 3; ++i) at(cell.centre, i) = place.centre[i];
  for (int i = 0; i < 9; ++i) at(cell.R, i) = place.R(i / 3, i % 3);
  cell.state.assign(samples.state(0), samples.state(0) + machine.state_size());
  for (int j = 0; j < machine.joints; ++j) {
    cell.cosine.push_back(std::cos(at(cell.state, j)));
    cell.sine.push_back(std::sin(at(cell.state, j)));
  }
  Rows changes = samples.expanded([&](int sample) { return samples.state_jacobian(sample); });
  cell.only_translates = only_translates(changes, variables, place.step);
  if (variables.loads) {
    const Rows offset = samples.expanded([&](int sample) { return samples.offset_jacobian(sample); });
    cell.offset_changes = samples.all_of(offset);
    changes.conservativeResize(changes.rows() + 6, Eigen::NoChange);
    changes.bottomRows<6>() = offset;
  }
  Eigen::VectorXd units(changes.rows());
  for (int j = 0; j < machine.joints; ++j) units[j] = at(machine.joint_turns, j) != 0 ? machine.length : 1;
  const Eigen::Index twists = changes.rows() - machine.joints;
  units.tail(twists) = units_of_twists(twists / 6, machine.length);
  cell.changes = samples.of_start(changes, units);
  return cell;
}

/// Measures at corners what the expansion of the offset misses, and how steps from the cell contract. No line
/// is bounded if one of them is not solved.
void measure_at_corners(const Problem& target, const CellPlace& place, const StartCell& kinematics,
                        StartCell& cell) {
  const FlatMachine& machine = target.machine();
  cell.bounds = offset_bounds(cell, place.step, load_of_cells, machine.length);
  const std::vector<Sample> corners = corners_about(place, machine.length);
  Batch in_cells;
  in_cells.cells.assign(corners.size(), &cell);
  in_cells.nominal_cells.assign(corners.size(), &kinematics);
  const auto solved = solve_samples(target, place, corners, std::move(in_cells));
  if (!solved) {
    cell.bounds.remainder.fill(std::numeric_limits<double>::infinity());
    return;
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector6 found = offset_of(place, corners[k], solved->nominal_tip.data() + 12 * k);
    const Vector6 missed =
        remainder_margin * (found - command_offset(cell, corners[k].p, corners[k].turn, corners[k].F));
    cell.bounds.remainder[0] = std::max(cell.bounds.remainder[0], missed.head<3>().norm());
    if (cell.variables.turns)
      cell.bounds.remainder[1] = std::max(cell.bounds.remainder[1], missed.tail<3>().norm());
  }
  // Corners are where starts miss most, but for larger loads.
  cell.contraction.fill(0);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    double& most = at(cell.contraction, static_cast<int>(acting_in(corners[k].F)));
    most = std::max(most, solved->contraction[k]);
  }
}

}  // namespace

std::optional<StartCell> make_kinematics_cell(const Question& nominal, const CellPlace& place,
                                              const std::vector<double>& start) {
  const FlatMachine& machine = *nominal.machine;
  const Variables variables{place.turns, false};
  const Samples samples = samples_about(place, variables, machine.length);
  const Problem kinematics{.real = {}, .nominal = nominal};
  const auto solutions =
      solve_samples(kinematics, place, samples.all, {.nominal_start = start, .response_to = variables});
  if (!solutions) return std::nullopt;
  return cell_of(machine, place, variables, {machine, place, variables, samples, *solutions});
}

std::optional<StartCell> make_target_cell(const Question& real, const Question& nominal,
                                          const CellPlace& place, const std::vector<double>& start,
                                          const StartCell& kinematics) {
  const FlatMachine& machine = *real.machine;
  const Variables variables{place.turns, true};
  const Samples samples = samples_about(place, variables, machine.length);
  const Problem target{.real = real, .nominal = nominal};
  const auto solutions =
      solve_samples(target, place, samples.all,
                    {.start = start, .nominal_start = kinematics.state, .response_to = variables});
  if (!solutions) return std::nullopt;
  const CellSamples of(machine, place, variables, samples, *solutions);
  StartCell cell = cell_of(machine, place, variables, of);
  cell.stress.assign(solutions->stress.begin(),
                     solutions->stress.begin() + 6 * static_cast<std::ptrdiff_t>(machine.elements.size()));
  cell.stress_changes = of.stress_changes();
  cell.pivots.assign(solutions->pivots.begin(), solutions->pivots.begin() + machine.unknowns());
  const Vector6 offset = offset_of(place, samples.all[0], solutions->nominal_tip.data());
  for (int i = 0; i < 6; ++i) at(cell.offset, i) = offset[i];
  measure_at_corners(target, place, kinematics, cell);
  return cell;
}

Vector6 command_offset(const StartCell& cell, const Vector3& p, const Vector3& turn, const Vector6& F) {
  Point<double> x;
  for (int i = 0; i < 3; ++i) x[i] = p[i] - at(cell.centre, i);
  for (int i = 0; i < 3 && cell.variables.turns; ++i) x[3 + i] = turn[i];
  for (int i = 0; i < 6 && cell.variables.loads; ++i) x[cell.variables.first_load() + i] = F[i];
  Vector6 offset;
  for (int i = 0; i < 6; ++i) offset[i] = at(cell.offset, i);
  const std::vector<Term>& terms = cell.offset_changes.terms;
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (int i = 0; i < 6; ++i) offset[i] += cell.offset_changes.coefficient(0, t, i) * x.value_of(terms[t]);
  return offset;
}

}  // namespace counterflex::kernel
