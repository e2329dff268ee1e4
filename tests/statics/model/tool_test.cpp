#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/theory.hpp"

using namespace counterflex;

namespace {

const std::string mill_file = COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml";
const std::string orthoglide_file = COUNTERFLEX_SOURCE_DIR "/samples/orthoglide-groove/machine.toml";

Tool radial(double k) {
  return {.from = ToolStiffness::radial, .yields = radial_tool(k)};
}

Load pushing(double fx, double fy, double fz) {
  return {(Vector6() << fx, fy, fz, 0, 0, 0).finished(), false};
}

/// A machine, and it with a tool.
struct Pair {
  Machine machine;
  Model base, bent;

  Pair(const Machine& of, const Tool& tool)
      : machine(of), base(prepare(of)), bent(prepare_with_tool(of, base, tool)) {}
};

Equilibrium loaded(const Model& model, const Vector3& p_MT, const Load& load) {
  const Pose X_MT{tip(model.mechanism, model.home).R, p_MT};
  const NominalResult nominal = follow(model, model.home, X_MT);
  REQUIRE(nominal.status == Status::converged);
  StaticsWork work(model.mechanism);
  Equilibrium result = solve_forward(model, nominal.configuration, load, {}, work);
  REQUIRE(result.status == Status::converged);
  return result;
}

Pose loaded_tip(const Model& model, const Vector3& p_MT, const Load& load) {
  return tip(model.mechanism, loaded(model, p_MT, load).configuration);
}

/// What a commanded target must be for the tip to be at `p_MT`.
Vector3 target_for(const Model& model, const Vector3& p_MT, const Load& load) {
  const Pose X_MT{tip(model.mechanism, model.home).R, p_MT};
  const NominalResult nominal = follow(model, model.home, X_MT);
  REQUIRE(nominal.status == Status::converged);
  StaticsWork work(model.mechanism);
  const Equilibrium solved = solve_target(model, nominal.configuration, X_MT, load, {}, work);
  REQUIRE(solved.status == Status::converged);
  const NominalResult commanded =
      nominal_forward(model, nominal.configuration, actuator_values(model.mechanism, solved.configuration));
  REQUIRE(commanded.status == Status::converged);
  return tip(model.mechanism, commanded.configuration).p;
}

struct Case {
  std::string file;
  std::vector<Vector3> places;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {mill_file, {{0.2, 0.1, -0.2}, {0.1, 0.2, -0.15}, {0.35, 0.02, -0.3}}},
      {orthoglide_file, {{0, 0, 0}, {0.03, -0.02, 0.04}, {-0.05, 0.05, -0.05}}}};
  return all;
}

}  // namespace

TEST_CASE("a very stiff tool bends a machine as no tool does") {
  for (const Case& c : cases()) {
    CAPTURE(c.file);
    const Pair pair(load_machine(c.file), radial(1e12));
    for (const Vector3& p : c.places) {
      const Load load = pushing(200, -100, 50);
      const Pose without = loaded_tip(pair.base, p, load), with = loaded_tip(pair.bent, p, load);
      CHECK((with.p - without.p).norm() < 1e-9);
      CHECK((with.R - without.R).norm() < 1e-9);
      CHECK((target_for(pair.bent, p, load) - target_for(pair.base, p, load)).norm() < 1e-9);
    }
  }
}

TEST_CASE("a machine with a tool starts at the home of the machine without, and goes where that goes") {
  for (const Case& c : cases()) {
    CAPTURE(c.file);
    const Pair pair(load_machine(c.file), radial(20e6));
    CHECK(pair.bent.home_status == Status::converged);
    CHECK((tip(pair.bent.mechanism, pair.bent.home).p - tip(pair.base.mechanism, pair.base.home).p).norm() <
          1e-15);
    CHECK(actuator_jacobian(pair.bent, pair.bent.home).condition ==
          doctest::Approx(actuator_jacobian(pair.base, pair.base.home).condition)
              .epsilon(0.5));  // lengths are in units of another l
    REQUIRE(pair.bent.mechanism.travel.size() == pair.base.mechanism.travel.size());
    for (const Vector3& p : c.places) {
      const Pose X_MT{tip(pair.base.mechanism, pair.base.home).R, p};
      const NominalResult a = follow(pair.base, pair.base.home, X_MT),
                          b = follow(pair.bent, pair.bent.home, X_MT);
      REQUIRE(a.status == Status::converged);
      REQUIRE(b.status == Status::converged);
      CHECK((actuator_values(pair.base.mechanism, a.configuration) -
             actuator_values(pair.bent.mechanism, b.configuration))
                .norm() < 1e-11);
      CHECK(
          (tip(pair.bent.mechanism, b.configuration).R - tip(pair.base.mechanism, a.configuration).R).norm() <
          1e-11);
    }
  }
}

TEST_CASE("a radial stiffness adds F/k to a serial machine, in the axes of the tip where it is") {
  const double k = 15e6;
  const Pair pair(load_machine(mill_file), radial(k));
  for (const Vector3& p : cases()[0].places) {
    const Load load = pushing(180, -240, 90);
    const Pose without = loaded_tip(pair.base, p, load), with = loaded_tip(pair.bent, p, load);
    // The tip's frame turns with the machine below it; axially the tool is rigid.
    const Vector3 f = with.R.transpose() * load.F.head<3>();
    const Vector3 bent = with.R * Vector3(f.x() / k, f.y() / k, 0);
    // The arm of the force grows by what the tool bends: that much more the machine below it bends.
    const double second_order = bent.norm() * load.F.head<3>().norm() / 1.2e6;
    CHECK((with.p - without.p - bent).norm() < second_order);
    CHECK((with.p - without.p - bent).norm() < 1e-4 * bent.norm());
  }
}

TEST_CASE("a radial stiffness adds exactly F/k where nothing below it turns") {
  const Machine machine = read_machine(
      "format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n[tool]\nxyz_mm = [0, 0, -80]\n"
      "[[chain]]\nname = \"axes\"\nelements = [\n"
      "{ actuator = \"prismatic\", axis = \"x\" }, { actuator = \"prismatic\", axis = \"y\" },\n"
      "{ actuator = \"prismatic\", axis = \"z\" },\n"
      "{ compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = 3e7 },\n"
      "{ compliance = \"prismatic\", axis = \"y\", stiffness_N_per_m = 2e7 },\n"
      "{ compliance = \"prismatic\", axis = \"z\", stiffness_N_per_m = 5e7 }]\n",
      "gantry.toml");
  for (const double k : {5e6, 40e6}) {
    const Pair pair(machine, radial(k));
    const Vector3 p(0.02, 0.05, -0.1);
    const Load load = pushing(300, -200, 100);
    const Vector3 more = loaded_tip(pair.bent, p, load).p - loaded_tip(pair.base, p, load).p;
    CHECK(std::abs(more.x() - 300 / k) < 1e-12 * p.norm());
    CHECK(std::abs(more.y() + 200 / k) < 1e-12 * p.norm());
    CHECK(std::abs(more.z()) < 1e-12 * p.norm());
  }
}

TEST_CASE("the Orthoglide, too, deflects by F/k more with a tool, to first order") {
  const double k = 10e6;
  const Pair pair(load_machine(orthoglide_file), radial(k));
  for (const Vector3& p : cases()[1].places) {
    for (const Vector3& f : {Vector3(100, 0, 0), Vector3(0, 100, 0), Vector3(60, -80, 0)}) {
      const Load load = pushing(f.x(), f.y(), f.z());
      const Vector3 more = loaded_tip(pair.bent, p, load).p - loaded_tip(pair.base, p, load).p;
      CHECK((more - f / k).norm() < 0.02 * 100 / k);
      const Vector3 back = target_for(pair.bent, p, load) - target_for(pair.base, p, load);
      CHECK((back + f / k).norm() < 0.02 * 100 / k);
    }
    const Load axial = pushing(0, 0, 100);
    CHECK((loaded_tip(pair.bent, p, axial).p - loaded_tip(pair.base, p, axial).p).norm() < 0.02 * 100 / k);
  }
}

TEST_CASE("a cantilever bends by FL^3/3EI and turns by FL^2/2EI, in the sense of the force") {
  const double L = 0.05, D = 0.006, F = 20, I = std::acos(-1.0) * std::pow(0.8 * D, 4) / 64, EI = 600e9 * I;
  const Tool tool{.diameter = D,
                  .stickout = L,
                  .from = ToolStiffness::cantilever,
                  .yields = {cantilever_tool(D, L, ToolMaterial::carbide)}};
  Machine machine = load_machine(mill_file);
  const Pair pair(machine, tool);
  const Vector3 p(0.2, 0.1, -0.2);
  const auto more = [&](const Load& load) {
    const Pose a = loaded_tip(pair.base, p, load), b = loaded_tip(pair.bent, p, load);
    return std::pair<Vector3, Vector3>{b.p - a.p, log_so3(b.R * a.R.transpose())};
  };
  const auto [along_x, turn_x] = more(pushing(F, 0, 0));
  CHECK(along_x.x() == doctest::Approx(F * L * L * L / (3 * EI)).epsilon(2e-3));
  CHECK(turn_x.y() == doctest::Approx(-F * L * L / (2 * EI)).epsilon(2e-3));
  const auto [along_y, turn_y] = more(pushing(0, F, 0));
  CHECK(along_y.y() == doctest::Approx(F * L * L * L / (3 * EI)).epsilon(2e-3));
  CHECK(turn_y.x() == doctest::Approx(F * L * L / (2 * EI)).epsilon(2e-3));
  const auto [along_z, turn_z] = more({(Vector6() << 0, 0, 0, 0, 0.5, 0).finished(), false});
  CHECK(along_z.x() == doctest::Approx(-0.5 * L * L / (2 * EI)).epsilon(2e-3));  // a moment bends it, too
  CHECK(turn_z.y() == doctest::Approx(0.5 * L / EI).epsilon(2e-3));
}

TEST_CASE("a length puts the tip below [spindle], for a rigid tool and one that bends") {
  Machine machine = load_machine(mill_file);
  machine.X_PS = Pose{Matrix3::Identity(), {0, 0, -0.02}};
  machine.tools[0] = {.length = 0.3};  // no tool is known: [tool]
  machine.tools[3] = {.length = 0.1};
  machine.tools[4] = {.length = 0.1, .from = ToolStiffness::radial, .yields = radial_tool(1e12)};
  machine.tools[5] = {.length = 0.06, .from = ToolStiffness::radial, .yields = radial_tool(1e12)};
  const Model base = prepare(machine);
  const ToolModels models = prepare_tools(machine, base, {0, 3, 4, 5, 6});
  REQUIRE(models.size() == 3);
  const auto height = [&](long tool) { return tip(models.at(tool).mechanism, models.at(tool).home).p.z(); };
  CHECK(height(3) - tip(base.mechanism, base.home).p.z() == doctest::Approx(0.08 - 0.12));
  CHECK(height(4) == doctest::Approx(height(3)).epsilon(1e-14));
  CHECK(height(5) - height(3) == doctest::Approx(0.04));
  // A longer arm tilts the head more, which resists moments about y with 1.5e6 N m/rad.
  const Load load = pushing(100, 0, 0);
  const Vector3 p(0.2, 0.1, -0.2);
  const Pose longer = loaded_tip(models.at(4), p, load), shorter = loaded_tip(models.at(5), p, load);
  CHECK(longer.p.x() - shorter.p.x() ==
        doctest::Approx(100 * (0.12 * 0.12 - 0.08 * 0.08) / 1.5e6).epsilon(1e-3));
  const Pose rigid = loaded_tip(models.at(3), p, load);
  CHECK((rigid.p - longer.p).norm() < 1e-9);
}

TEST_CASE(
    "the nominal path of a machine whose tools change begins each at its home, in the orientation it has "
    "there") {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-spindle/machine.toml");
  machine.X_PS = machine.X_PT * Pose{exp_so3(Vector3(0.3, -0.2, 0.1)), {0.01, 0, 0.02}};
  machine.tools[1] = {.length = 0.1};
  const Model base = prepare(machine);
  const ToolModels models = prepare_tools(machine, base, {1});
  const Vector3 p = tip(base.mechanism, base.home).p + Vector3(0.05, -0.03, 0.02);
  NominalToolPath path(base);
  for (const Model* model : {&base, &models.at(1), &base}) {
    REQUIRE(path.go_to(*model, p) == Status::converged);
    const Pose home = tip(model->mechanism, model->home);
    CHECK((path.orientation() - home.R).norm() < 1e-9);
    CHECK((tip(model->mechanism, path.configuration()).p - p).norm() < 1e-9);
    const NominalResult alone = follow(*model, model->home, {home.R, p});
    CHECK((actuator_values(model->mechanism, path.configuration()) -
           actuator_values(model->mechanism, alone.configuration))
              .norm() < 1e-9);
  }
}

TEST_CASE("a wrench at the platform keeps the arm of the reference point when a tool bends") {
  for (const Case& c : cases()) {
    CAPTURE(c.file);
    const Pair pair(load_machine(c.file), radial(1e12));
    for (const Vector3& p : c.places) {
      const Load load{(Vector6() << 150, 80, -40, 3, -2, 1).finished(), true};
      const Pose without = loaded_tip(pair.base, p, load), with = loaded_tip(pair.bent, p, load);
      CHECK((with.p - without.p).norm() < 1e-9);
      CHECK((with.R - without.R).norm() < 1e-9);
    }
  }
}

TEST_CASE("all methods agree on a machine with a tool, to which linear theory adds F/k") {
  for (const Case& c : cases()) {
    CAPTURE(c.file);
    const Pair pair(load_machine(c.file), radial(10e6));
    const Load load = pushing(120, -60, 30);
    for (const Vector3& p : c.places) {
      const Pose X_MT{tip(pair.bent.mechanism, pair.bent.home).R, p};
      const NominalResult nominal = follow(pair.bent, pair.bent.home, X_MT);
      StaticsWork work(pair.bent.mechanism);
      const Equilibrium direct = solve_target(pair.bent, nominal.configuration, X_MT, load, {}, work);
      const Equilibrium nested = solve_target_nested(pair.bent, nominal.configuration, X_MT, load, {}, work);
      REQUIRE(direct.status == Status::converged);
      REQUIRE(nested.status == Status::converged);
      CHECK((actuator_values(pair.bent.mechanism, direct.configuration) -
             actuator_values(pair.bent.mechanism, nested.configuration))
                .norm() < 1e-9);
      const NominalResult bare = follow(pair.base, pair.base.home, X_MT);
      StaticsWork bare_work(pair.base.mechanism);
      const LinearResult without = linear_deviation(pair.base, bare.configuration, load, {}, bare_work),
                         with = linear_deviation(pair.bent, nominal.configuration, load, {}, work);
      REQUIRE(with.status == Status::converged);
      CHECK((with.dt_T - without.dt_T).head<3>().isApprox(Vector3(120, -60, 0) / 10e6, 1e-6));
      CHECK((with.dt_T - without.dt_T).tail<3>().norm() < 1e-12);
    }
  }
}

TEST_CASE(
    "loads without the tool are those of the machine's own chains, for any tool that bends behind them") {
  const Load load = pushing(100, -30, 20);
  for (const auto& [file, p_MT] :
       {std::pair{mill_file, Vector3(0.2, 0.1, -0.2)}, {orthoglide_file, Vector3(0.02, 0.01, -0.05)}}) {
    const auto& shown = file;
    CAPTURE(shown);
    const Machine machine = load_machine(file);
    const Pair soft(machine, radial(1e6));
    const auto base = loads(soft.base.mechanism, soft.base, loaded(soft.base, p_MT, load).configuration);
    const Configuration bent = loaded(soft.bent, p_MT, load).configuration;
    const auto with = loads(soft.base.mechanism, soft.bent, bent);
    REQUIRE(with.size() == base.size());
    for (std::size_t i = 0; i < base.size(); ++i) {
      CHECK(with[i].name == base[i].name);
      CHECK(with[i].wrench.norm() > 1);
      for (const LoadKind kind : load_kinds)  // 0.1 mm more of arm for the force
        CHECK(with[i][kind] == doctest::Approx(base[i][kind]).epsilon(0.01));
    }
    CHECK(loads(soft.bent.mechanism, soft.bent, bent).front()[LoadKind::spring_translation] >
          0.9e-4);  // the tool's own, F/k
  }
}

TEST_CASE("the moment on a chain's end is about the reference point of the deflected machine") {
  const Machine machine = load_machine(mill_file);
  const Pair soft(machine, radial(1e6));
  const Vector3 p_MT(0.2, 0.1, -0.2);
  const Load load = pushing(3000, -500, 200);
  const Configuration bent = loaded(soft.bent, p_MT, load).configuration;
  const Vector6 F = loads(soft.base.mechanism, soft.bent, bent).at(0).wrench;
  // The same wrench bends the machine without the tool in the same way.
  const Configuration bare = loaded(soft.base, p_MT, {F, true}).configuration;
  const Vector3 arm = tip(soft.bent.mechanism, bent).p - bare.X_MP.p;
  CHECK((F.head<3>() - load.F.head<3>()).norm() < 1e-6);
  CHECK((F.tail<3>() - arm.cross(Vector3(load.F.head<3>()))).norm() < 1e-6);
}
