/// Tables of errors of motion: their interpolation, and what they do to a machine.
#include "model/motion_errors.hpp"

#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_tables.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

const Joint along_x{JointKind::prismatic, Vector3::UnitX()};

ErrorTable table_of(const std::vector<double>& positions, const std::vector<double>& EXX) {
  ErrorTable table{"t", positions, {}};
  for (const double e : EXX) table.errors.push_back(e * unit(0));
  return table;
}

/// EXX and its slope at a value of the actuator.
std::pair<double, double> at(const MotionErrors& errors, double rho) {
  const JointMotion motion = joint_motion(along_x, errors, rho, rho, 1);
  return {motion.X.p.x() - rho, motion.v.x() - 1};
}

// A mill without springs: X carries Y, Y carries Z, and the tip is 80 mm below the platform.
Machine mill(const std::string& tables, const std::string& errors = "") {
  const auto axis = [&](char letter, const char* more) {
    const bool has = tables.find(std::string("[error_tables.") + letter) != std::string::npos;
    return std::string("{ actuator = \"prismatic\", axis = \"") + letter + "\"" + more +
           (has ? std::string(", error_table = \"") + letter + "\"" : "") + " },\n";
  };
  return read_machine("format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n" +
                          std::string("[tool]\nxyz_mm = [0, 0, -80]\n") + tables +
                          "[[chain]]\nname = \"axes\"\nelements = [\n" +
                          axis('x', ", min_mm = 0, max_mm = 400") + "{ error = \"y_to_x\" },\n" +
                          axis('y', ", min_mm = 0, max_mm = 250") + "{ error = \"z_to_y\" },\n" +
                          axis('z', ", min_mm = -300, max_mm = 0") + "]\n" + errors,
                      "mill.toml");
}

}  // namespace

TEST_CASE("a table has its values at its positions, and is constant outside them") {
  const MotionErrors errors = motion_errors(table_of({0, 0.1, 0.25, 0.3}, {1e-5, 3e-5, 2e-5, 2e-5}), {});
  for (const auto& [place, e] : std::vector<std::pair<double, double>>{
           {-0.5, 1e-5}, {0, 1e-5}, {0.1, 3e-5}, {0.25, 2e-5}, {0.3, 2e-5}, {0.7, 2e-5}}) {
    const double rho = place;
    CAPTURE(rho);
    CHECK(at(errors, rho).first == doctest::Approx(e).epsilon(1e-9));
  }
  CHECK(at(errors, -0.01).second == 0);
  CHECK(at(errors, 0.31).second == 0);
}

TEST_CASE("between positions a table is continuous, and so is its slope, which is its derivative") {
  Random random(3);
  for (int n = 0; n < 20; ++n) {
    const ErrorTable table = random_table(random, 1);
    const MotionErrors errors = motion_errors(table, {});
    for (std::size_t k = 1; k + 1 < table.positions.size(); ++k) {
      const double position = table.positions[k];
      CHECK(at(errors, position - 1e-12).second ==
            doctest::Approx(at(errors, position + 1e-12).second).epsilon(1e-6));
      const double between = position + 0.37 * (table.positions[k + 1] - position);
      const double slope = central_difference([&](double h) { return at(errors, between + h).first; }, 1e-4);
      CHECK(std::abs(at(errors, between).second - slope) < 1e-10);
    }
  }
}

TEST_CASE("a table with deviations is linear in its values, with a continuous slope that is its derivative") {
  const auto stated = [](const std::vector<double>& errors) {
    ErrorTable table = table_of({-0.2, 0, 0.05, 0.3}, errors);
    table.sigma = 1e-5;
    return motion_errors(table, {});
  };
  const MotionErrors a = stated({1e-5, 3e-5, 2e-5, 4e-5}), b = stated({0, -1e-5, 5e-5, 1e-5}),
                     sum = stated({2e-5, 5e-5, 9e-5, 9e-5});  // 2 a + b
  for (const double rho : {-0.2, -0.11, 0.03, 0.05, 0.2, 0.29}) {
    CAPTURE(rho);
    CHECK(at(sum, rho).first == doctest::Approx(2 * at(a, rho).first + at(b, rho).first).epsilon(1e-9));
    const double slope = central_difference([&](double h) { return at(a, rho + h).first; }, 1e-5);
    if (rho > -0.2) CHECK(std::abs(at(a, rho).second - slope) < 1e-7);
  }
  CHECK(at(a, 0.05 - 1e-12).second == doctest::Approx(at(a, 0.05 + 1e-12).second).epsilon(1e-6));
}

TEST_CASE("a table has no extremes between its positions, and reproduces straight lines") {
  Random random(4);
  const ErrorTable table = random_table(random, 1);
  const MotionErrors errors = motion_errors(table, {});
  for (std::size_t k = 0; k + 1 < table.positions.size(); ++k)
    for (int i = 0; i <= 20; ++i) {
      const double a = table.errors[k][0], b = table.errors[k + 1][0];
      const double e =
          at(errors, table.positions[k] + i / 20.0 * (table.positions[k + 1] - table.positions[k])).first;
      CHECK(e >= std::min(a, b) - 1e-15);
      CHECK(e <= std::max(a, b) + 1e-15);
    }
  const MotionErrors line = motion_errors(table_of({-0.2, 0, 0.05, 0.3}, {-2e-5, 0, 5e-6, 3e-5}), {});
  for (const double rho : {-0.13, -0.01, 0.03, 0.2}) {
    CHECK(std::abs(at(line, rho).first - 1e-4 * rho) < 1e-16);
    CHECK(std::abs(at(line, rho).second - 1e-4) < 1e-14);
  }
}

TEST_CASE("positions of a table are shown values") {
  const ErrorTable table = table_of({0.1, 0.2, 0.4}, {1e-5, 4e-5, 2e-5});
  const ShownValue shown{-1, 0.05, {}};
  const MotionErrors errors = motion_errors(table, shown), plain = motion_errors(table, {});
  for (const double rho : {-0.4, -0.3, -0.1, -0.05, 0.0}) {
    const double s = shown.sign * rho + shown.zero;
    CHECK(at(errors, rho).first == doctest::Approx(at(plain, s).first).epsilon(1e-9));
    CHECK(at(errors, rho).second == doctest::Approx(-at(plain, s).second).epsilon(1e-9));
  }
}

TEST_CASE("harmonics turn a rotary axis about itself by their sum at the shown value, in its sense") {
  Actuator actuator;
  actuator.joint = {JointKind::revolute, Vector3(0, 0.6, 0.8)};
  actuator.harmonics = {1e-4, -2e-4, 3e-5, 5e-5};
  for (const double sign : {1.0, -1.0}) {
    actuator.shown = {sign, 0.4, {}};
    const MotionErrors errors = motion_errors(actuator);
    for (const double rho : {-7.0, -0.3, 0.0, 1.1, 5.0}) {
      CAPTURE(rho);
      const double s = sign * rho + 0.4;
      const double turn =
          1e-4 * std::sin(s) - 2e-4 * std::cos(s) + 3e-5 * std::sin(2 * s) + 5e-5 * std::cos(2 * s);
      const JointMotion motion = joint_motion(actuator.joint, errors, rho, rho, 1);
      CHECK((motion.X.R - exp_so3((rho + sign * turn) * actuator.joint.axis)).norm() < 1e-14);
      CHECK(motion.X.p.isZero(0));
      const double slope = central_difference(
          [&](double h) { return error_along(actuator.joint, errors, rho + h).error; }, 1e-4);
      CHECK((motion.w - (1 + slope) * actuator.joint.axis).norm() < 1e-11);
    }
  }
  actuator.harmonics = {0, 0};
  CHECK(motion_errors(actuator).empty());
}

TEST_CASE("errors of a rotary axis are in the axes of the frame before it") {
  ErrorTable table{"c", {-4, 4}, {}};
  Vector6 error;
  error << 1e-5, 2e-5, 3e-5, 4e-6, -5e-6, 6e-6;
  table.errors = {error, error};
  const JointMotion motion =
      joint_motion({JointKind::revolute, Vector3::UnitZ()}, motion_errors(table, {}), pi / 2, pi / 2, 1);
  CHECK((motion.X.p - error.head<3>()).norm() < 1e-18);
  const Matrix3 R = motion.X.R * exp_so3({0, 0, -pi / 2});
  CHECK((log_so3(R) - error.tail<3>()).norm() < 1e-15);
}

// By hand: the tip moves by the translation, and by the rotation vector times the way from the origin of the
// frame behind the axis to the tip.
TEST_CASE("each of the 21 unit errors of a three-axis machine moves the tip as small transforms do") {
  const double e = 1e-5;
  const Vector3 at_tip(0.1, 0.05, -0.11);  // X 100, Y 50, Z -30, and 80 mm of tool
  struct Error {
    std::string name, tables, errors;
    Vector3 expected;
  };
  std::vector<Error> all;
  const std::string letters = "XYZABC";
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 lever = Vector3::Zero();  // from the frame behind the axis to the tip
    for (int k = axis + 1; k < 3; ++k) lever[k] += k == 2 ? -0.03 : 0.05;
    lever.z() -= 0.08;
    for (int i = 0; i < 6; ++i) {
      const std::string key = std::string("E") + letters[static_cast<std::size_t>(i)] + "XYZ"[axis];
      const std::string unit = i < 3 ? "_um" : "_urad";
      const Vector3 direction = Vector3::Unit(i % 3);
      all.push_back({key,
                     std::string("[error_tables.") + "xyz"[axis] + "]\npositions_mm = [-500, 500]\n" + key +
                         unit + " = [10, 10]\n",
                     "", i < 3 ? Vector3(e * direction) : Vector3(e * direction.cross(lever))});
    }
  }
  const Vector3 behind_x(0, 0.05, -0.11), behind_y(0, 0, -0.11);
  const auto slot = [&](const char* name, int i) {
    std::string rpy[3] = {"0", "0", "0"};
    rpy[i] = "5.729577951308232e-4";
    return std::string("errors.") + name + " = { rpy_deg = [" + rpy[0] + ", " + rpy[1] + ", " + rpy[2] +
           "] }\n";
  };
  all.push_back({"C0Y", "", slot("y_to_x", 2), e * Vector3::UnitZ().cross(behind_x)});
  all.push_back({"A0Z", "", slot("z_to_y", 0), e * Vector3::UnitX().cross(behind_y)});
  all.push_back({"B0Z", "", slot("z_to_y", 1), e * Vector3::UnitY().cross(behind_y)});
  REQUIRE(all.size() == 21);
  for (const Error& error : all) {
    CAPTURE(error.name);
    const Model model = prepare(mill(error.tables, error.errors));
    StaticsWork work(model.mechanism);
    const Pose X_MT{Matrix3::Identity(), at_tip};
    const NominalResult nominal = follow(model, model.home, X_MT);
    REQUIRE(nominal.status == Status::converged);
    const Equilibrium found = solve_forward(model, nominal.configuration, {}, {}, work);
    REQUIRE(found.status == Status::converged);
    CHECK((tip(model.mechanism, found.configuration).p - at_tip - error.expected).norm() < 1e-10);
    const Equilibrium target = solve_target(model, nominal.configuration, X_MT, {}, {}, work);
    REQUIRE(target.status == Status::converged);
    const Eigen::VectorXd rho = actuator_values(model.mechanism, target.configuration);
    CHECK((rho - Vector3(0.1, 0.05, -0.03) + error.expected).norm() < 1e-9);
  }
}

TEST_CASE("the actuator of a target is where its value and the error of the table there make the position") {
  const std::string table =
      "[error_tables.x]\npositions_mm = [0, 100, 200, 300, 400]\nEXX_um = [0, 120, 80, -60, 40]\n";
  const Machine machine = mill(table);
  const Model model = prepare(machine);
  const MotionErrors& errors = model.mechanism.chains[0].parts[0].errors.empty()
                                   ? model.mechanism.chains[0].parts[1].errors
                                   : model.mechanism.chains[0].parts[0].errors;
  REQUIRE_FALSE(errors.empty());
  StaticsWork work(model.mechanism);
  for (const double x : {0.0, 0.05, 0.1003, 0.25, 0.31, 0.4}) {
    CAPTURE(x);
    const Pose X_MT{Matrix3::Identity(), Vector3(x, 0.05, -0.11)};
    const NominalResult nominal = follow(model, model.home, X_MT);
    const Equilibrium target = solve_target(model, nominal.configuration, X_MT, {}, {}, work);
    REQUIRE(target.status == Status::converged);
    const double rho = actuator_values(model.mechanism, target.configuration)[0];
    CHECK(std::abs(rho + at(errors, rho).first - x) < 1e-14);
    const LinearResult linear = linear_deviation(model, nominal.configuration, {}, {}, work);
    CHECK(std::abs(linear.dt_T[0] - at(errors, x).first) < 1e-14);
  }
}

TEST_CASE("without errors in the stage, or as a perfect machine, a table does nothing") {
  const Machine machine =
      mill("[error_tables.x]\npositions_mm = [0, 400]\nEXX_um = [50, -50]\nECX_arcsec = [9, 9]\n");
  const Model model = prepare(machine), plain = prepare(perfect(machine));
  StaticsWork work(model.mechanism), plain_work(plain.mechanism);
  const Pose X_MT{Matrix3::Identity(), Vector3(0.1, 0.05, -0.11)};
  const NominalResult nominal = follow(model, model.home, X_MT);
  const Equilibrium without = solve_forward(model, nominal.configuration, {}, {.errors = 0}, work);
  CHECK(deviation(tip(model.mechanism, without.configuration), X_MT).norm() < 1e-15);
  const Equilibrium of_perfect = solve_forward(plain, nominal.configuration, {}, {}, plain_work);
  CHECK(deviation(tip(plain.mechanism, of_perfect.configuration), X_MT).norm() < 1e-15);
}
