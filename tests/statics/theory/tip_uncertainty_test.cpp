#include "counterflex/statics/tip_uncertainty.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/fixture.hpp"

using namespace counterflex;

namespace {

Machine made_with(MachineKind kind, const std::string& more) {
  MachineFacts facts;
  facts.kind = kind;
  if (kind == MachineKind::robot6r) facts.robot = "ur10";
  return read_machine(machine_file(facts) + more, "made.toml");
}

/// A machine away from home, under a load.
struct Posed {
  Machine machine;
  Eigen::VectorXd drho;
  Load load;

  Equilibrium solve(const Model& model) const {
    StaticsWork work(model.mechanism);
    const NominalResult nominal =
        nominal_forward(model, model.home, actuator_values(model.mechanism, model.home) + drho);
    REQUIRE(nominal.status == Status::converged);
    const Equilibrium found = solve_forward(model, nominal.configuration, load, Stage{}, work);
    REQUIRE(found.status == Status::converged);
    return found;
  }
  Pose tip_now() const {
    const Model model = prepare(machine);
    return tip(model.mechanism, solve(model).configuration);
  }
};

Posed posed(const Machine& machine) {
  Posed result{machine, {}, {}};
  const auto count = static_cast<Eigen::Index>(prepare(machine).mechanism.travel.size());
  result.drho.resize(count);
  for (Eigen::Index a = 0; a < count; ++a) result.drho[a] = a % 2 == 0 ? 0.012 : -0.009;
  result.load.F << 80, -50, 120, 1, -2, 0.5;
  return result;
}

TipCovariance covariance_of(const Posed& at) {
  const Model model = prepare(at.machine);
  const TipUncertainty uncertainty(at.machine, model);
  StaticsWork work = uncertainty.work();
  return uncertainty.of_tip(at.solve(model).configuration, at.load, work);
}

/// Relative difference of two matrices in position and rotation.
double apart(const Matrix6& a, const Matrix6& b) {
  return (a - b).norm() / b.norm();
}

Matrix6 square(const Vector6& v) {
  return v * v.transpose();
}

}  // namespace

TEST_CASE("the force's part of a covariance is that of two solves with a little more and less force") {
  for (const MachineKind kind : {MachineKind::mill3, MachineKind::robot6r, MachineKind::delta}) {
    CAPTURE(static_cast<int>(kind));
    const Posed at = posed(made_with(kind, "\n[uncertainty]\nforce_percent = 20\n"));
    Posed more = at, less = at;
    more.load.F *= 1.001;
    less.load.F *= 0.999;
    const Vector6 by_force = difference(more.tip_now(), less.tip_now()) / 0.002;
    CHECK(apart(covariance_of(at).force, square(0.2 * by_force)) < 1e-4);
  }
}

TEST_CASE("parameters with deviations in the file count, each with its own tangent") {
  Machine machine = made_with(MachineKind::mill3, "\n[uncertainty]\n");
  machine.parameters.clear();
  const std::vector<Parameter> all = parameters(machine);
  std::vector<double> values;
  for (const Parameter& parameter : all) values.push_back(parameter.value);
  Matrix6 expected = Matrix6::Zero();
  Posed at = posed(machine);
  for (const std::size_t i : {std::size_t{0}, all.size() / 2, all.size() - 1}) {
    if (all[i].kind == ParameterKind::reversal) continue;
    const bool is_scale = all[i].kind == ParameterKind::compliance || all[i].kind == ParameterKind::mass;
    const double step = is_scale ? 1e-3 * all[i].value : 1e-5, sigma = 3 * step;
    at.machine.parameters.push_back({all[i].name, NumberSource::measured, sigma});
    std::vector<double> moved = values;
    Posed up = at, down = at;
    moved[i] = values[i] + step;
    up.machine = with_parameters(machine, moved);
    moved[i] = values[i] - step;
    down.machine = with_parameters(machine, moved);
    expected += square(sigma / (2 * step) * difference(up.tip_now(), down.tip_now()));
  }
  REQUIRE(at.machine.parameters.size() >= 2);
  CHECK(apart(covariance_of(at).parameters, expected) < 1e-4);
}

TEST_CASE("a known covariance replaces the deviations of its parameters, with its correlation") {
  Machine machine = made_with(MachineKind::mill3, "\n[uncertainty]\n");
  machine.parameters.clear();
  const std::vector<Parameter> all = parameters(machine);
  machine.parameters.push_back({all[0].name, NumberSource::measured, 1e3});
  KnownParameters known{{all[0].name, all[1].name}, Eigen::Matrix2d{{4e-12, 2e-12}, {2e-12, 9e-12}}};
  machine.uncertainty->known = known;
  const Posed at = posed(machine);
  const Model model = prepare(machine);
  const ParameterTangents tangents(machine, model, {0, 1});
  StaticsWork work = tangents.work();
  const Eigen::MatrixXd J = tangents.of_tip(at.solve(model).configuration, at.load, work);
  CHECK(apart(covariance_of(at).parameters, J * known.covariance * J.transpose()) < 1e-12);
}

TEST_CASE("tool length counts along the tool's axis, repeatability in all directions") {
  const Posed at =
      posed(made_with(MachineKind::robot6r,
                      "\n[uncertainty]\ntool_length_um = 30\nrepeatability_um = 4\nforce_percent = 0\n"));
  const Vector3 axis = at.tip_now().R.col(2);
  Matrix6 expected = Matrix6::Zero();
  expected.topLeftCorner<3, 3>() = 900e-12 * axis * axis.transpose() + 16e-12 * Matrix3::Identity();
  const TipCovariance found = covariance_of(at);
  CHECK(apart(found.others, expected) < 1e-12);
  CHECK(found.force.isZero(0));
}

TEST_CASE("a temperature shifts the tip as the table of the machine does") {
  const std::string table =
      "\n[thermal]\ntemperature_C = [20, 25, 30]\nx_um = [0, 10, 40]\ny_um = [0, -5, -6]\nspindle_um = [0, "
      "20, "
      "30]\n\n[uncertainty]\ntemperature_K = 0.5\nforce_percent = 0\n";
  const Machine machine = made_with(MachineKind::mill3, table);
  Posed at = posed(at_temperature(machine, 22)), warm = at, cold = at;
  warm.machine = at_temperature(machine, 22.5);
  cold.machine = at_temperature(machine, 21.5);
  const Vector3 shift = warm.tip_now().p - cold.tip_now().p;
  const Matrix3 expected = 0.25 * shift * shift.transpose();
  CHECK((covariance_of(at).others.topLeftCorner<3, 3>() - expected).norm() < 1e-4 * expected.norm());
}

TEST_CASE("a machine at a temperature takes another one as if it had none") {
  const Machine machine = made_with(
      MachineKind::mill3, "\n[thermal]\ntemperature_C = [20, 30]\nx_um = [0, 40]\nspindle_um = [0, 30]\n");
  const Posed once = posed(at_temperature(machine, 27)),
              twice = posed(at_temperature(at_temperature(machine, 21), 27));
  CHECK((once.tip_now().p - twice.tip_now().p).norm() == 0);
}

TEST_CASE("where the part deflects, its twist belongs to the force") {
  const Posed at = posed(made_with(MachineKind::mill3,
                                   "\n[fixture]\nxyz_mm = [0, 0, -50]\nstiffness_N_per_um = [20, 30, 40]\n\n"
                                   "[uncertainty]\nforce_percent = 10\n"));
  const auto relative = [&](double factor) {
    Posed other = at;
    other.load.F *= factor;
    const Pose X = other.tip_now();
    return inverse(deflected_part(*at.machine.fixture, other.load.F, X.p)) * X;
  };
  const Vector6 by_force = difference(relative(1.001), relative(0.999)) / 0.002;
  CHECK(apart(covariance_of(at).force, square(0.1 * by_force)) < 1e-4);
}

TEST_CASE("a band is along the deviation, or in the most uncertain direction where it is wider than that") {
  const Matrix3 C = Vector3(1, 4, 9).asDiagonal();
  CHECK(band({10, 0, 0}, C) == doctest::Approx(2));
  CHECK(band({0, 10, 0}, C) == doctest::Approx(4));
  CHECK(band({1.9, 0, 0}, C) == doctest::Approx(6));
  CHECK(band({0, 0, 0}, C) == doctest::Approx(6));
  CHECK(band({3, 4, 0}, C) == doctest::Approx(2 * std::sqrt((9.0 + 4 * 16) / 25)));
  CHECK(std::abs(band_direction({0, 0, 0}, C).z()) == doctest::Approx(1));
  // A rounding error in a direction without uncertainty is no deviation.
  CHECK(std::abs(band_direction({1e-18, 0, 0}, Vector3(0, 4, 9).asDiagonal()).z()) == doctest::Approx(1));
}

TEST_CASE("with a tool a band has the parameters of the machine, and of [tool] only the zero") {
  const auto gantry = [](const std::string& zero) {
    return read_machine(
        "format = \"counterflex-machine 1\"\nname = \"gantry\"\ncontrolled = [\"x\", \"y\", \"z\"]\n"
        "gravity_m_s2 = [0, 0, -9.81]\n" +
            zero +
            "[tool]\nxyz_mm = [0, 0, -90]\nmass = { kg = 10, at_mm = [0, 0, 60] }\n"
            "[tools.T1]\nmass = { kg = 30, at_mm = [5, 0, 60] }\n[uncertainty]\nforce_percent = 0.001\n"
            "[parameters]\n\"tool.kg\" = { sigma = 5, source = \"prior\" }\n"
            "\"head.z_m_per_N\" = { prior_percent = 40, source = \"prior\" }\n"
            "[springs.head]\nstiffness_diag_si = [1e9, 1e9, 1e7, 1e6, 1e6, 1e6]\n"
            "[[chain]]\nname = \"axes\"\nelements = [\n"
            "{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 400 },\n"
            "{ actuator = \"prismatic\", axis = \"y\", min_mm = 0, max_mm = 300 },\n"
            "{ actuator = \"prismatic\", axis = \"z\", min_mm = -300, max_mm = 0 },\n{ spring = \"head\" "
            "},\n]\n",
        "gantry.toml");
  };
  // Chains that have become branches before the tool.
  const Machine delta = made_with(MachineKind::delta,
                                  "\n[uncertainty]\nforce_percent = 10\n[tools.T1]\nmass = { kg = 2 }\n"
                                  "holder_N_per_um = 20\n");
  for (const Machine& machine : {gantry(""), gantry("gravity_reference = \"home\"\n"), delta}) {
    CAPTURE(machine.name);
    const Tool& tool = machine.tools.at(1);
    const auto with_tool_1 = [&](const Machine& of) { return prepare_with_tool(of, prepare(of), tool); };
    Load load;
    load.F << 20, -10, 30, 0, 0, 0;
    const auto solved = [&](const Model& model) {
      StaticsWork work(model.mechanism);
      const NominalResult nominal =
          nominal_forward(model, model.home, actuator_values(model.mechanism, with_tool_1(machine).home));
      const Equilibrium found = solve_forward(model, nominal.configuration, load, Stage{}, work);
      REQUIRE(found.status == Status::converged);
      return found.configuration;
    };
    const KnownParameters known = uncertain_parameters(machine);
    const std::vector<std::size_t> at = parameter_indices(machine, known.names);
    REQUIRE(at.size() >= 2);
    std::vector<double> values;
    for (const Parameter& parameter : parameters(machine)) values.push_back(parameter.value);
    Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, known.covariance.cols());
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double step = 1e-2 * std::sqrt(known.covariance(i, i));
      const auto tip_at = [&](double by) {
        std::vector<double> moved = values;
        moved[at[k]] += by;
        const Model model = with_tool_1(with_parameters(machine, moved));
        return tip(model.mechanism, solved(model));
      };
      J.col(i) = difference(tip_at(step), tip_at(-step)) / (2 * step);
    }
    const Model model = with_tool_1(machine);
    const TipUncertainty uncertainty(machine, model, &tool);
    StaticsWork work = uncertainty.work();
    const Matrix6 found = uncertainty.of_tip(solved(model), load, work).parameters;
    CHECK(apart(found, J * known.covariance * J.transpose()) < 1e-3);
  }
}

TEST_CASE(
    "at the place where the part was touched off, the machine's parameters are not uncertain without a "
    "load") {
  Posed at = posed(made_with(MachineKind::robot6r, "\n[uncertainty]\nrepeatability_um = 3\n"));
  const Model model = prepare(at.machine);
  const TipUncertainty uncertainty(at.machine, model);
  StaticsWork work = uncertainty.work();
  at.load = {};
  const Configuration there = at.solve(model).configuration;
  at.drho *= -1;
  const Configuration elsewhere = at.solve(model).configuration;
  const auto variances = [&](const Configuration& touched, const Vector3& axes) {
    const DatumTangents datum = uncertainty.of_datum(touched, axes, work);
    return Vector3(uncertainty.of_tip(there, {}, work, datum).parameters.diagonal().head<3>());
  };
  const TipCovariance alone = uncertainty.of_tip(there, {}, work);
  const Vector3 all = alone.parameters.diagonal().head<3>();
  CHECK(all.minCoeff() > 1e-12);
  CHECK(variances(there, Vector3::Ones()).maxCoeff() < 1e-12 * all.maxCoeff());
  const Vector3 only_z = variances(there, Vector3::UnitZ());
  CHECK(only_z.x() == all.x());
  CHECK(only_z.z() < 1e-12 * all.z());
  const Vector3 far = variances(elsewhere, Vector3::Ones());
  CHECK(far.maxCoeff() > 1e-4 * all.maxCoeff());
  CHECK(far.maxCoeff() < all.maxCoeff());
  const TipCovariance touched =
      uncertainty.of_tip(there, {}, work, uncertainty.of_datum(there, Vector3::UnitZ(), work));
  CHECK(touched.others(0, 0) == alone.others(0, 0));
  CHECK(touched.others(2, 2) == 2 * alone.others(2, 2));
}
