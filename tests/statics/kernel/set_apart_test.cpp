/// Elements set apart as a group of one branch leave a machine as it was: condensed, with weights, the
/// group's branch must feel every turn of its start frame.
#include <fmt/format.h>

#include "model/part.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// The elements from `first` to before `last`, as a group of one branch.
Machine set_apart(Machine machine, int first, int last) {
  std::vector<Element>& elements = machine.chains[0].elements;
  const std::vector<Element> inner(elements.begin() + first, elements.begin() + last);
  elements.insert(elements.erase(elements.begin() + first, elements.begin() + last),
                  Group{{Branch{"apart", inner}}});
  return machine;
}

// The 6R robot with masses everywhere: its forearm apart; with the joints about it too; and an elbow within
// an arm.
struct Robots {
  Machine plain, forearm, joints, nested;
};

Robots robots(double kg) {
  Machine plain = heavy(machine_of("serial6r_link6"), kg);
  const auto& elements = plain.chains[0].elements;
  const auto spring = std::find_if(elements.begin(), elements.end(),
                                   [](const Element& e) { return std::get_if<Spring>(&e) != nullptr; });
  const int at = static_cast<int>(spring - elements.begin());
  return {plain, set_apart(plain, at - 2, at + 2), set_apart(plain, at - 8, at + 6),
          set_apart(set_apart(plain, at - 6, at + 2), at - 12, at - 1)};
}

int size_of(const Part& part) {
  return part.column < 0 ? 0 : part.kind == PartKind::spring ? 6 : 1;
}

// Gives a series the coordinates `x` in their order, from `next` on; its groups end where their branch does.
Pose fill(const Series& series, const Eigen::VectorXd& x, int& next, SeriesState& state) {
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::group) {
      GroupState& group = state.groups[static_cast<std::size_t>(part.group)];
      group.X =
          fill(series.groups[static_cast<std::size_t>(part.group)].branches[0], x, next, group.branches[0]);
    } else if (const int size = size_of(part); size > 0) {
      state.x.segment(part.column, size) = x.segment(next, size);
      next += size;
    }
    X = X * part_pose(part, state, {});
  }
  return X;
}

// Gives branches the wrenches with which the ends of their groups are in balance; nothing else need be.
void balance(const Series& series, const SeriesWork& work, SeriesState& state) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto g = static_cast<std::size_t>(part.group);
    SeriesState& branch = state.groups[g].branches[0];
    branch.F -= work.gradient.segment<6>(part.column);
    balance(series.groups[g].branches[0], work.groups[g][0], branch);
  }
}

void collect(const Series& series, const SeriesState& state, std::vector<double>& x) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::group)
      collect(series.groups[static_cast<std::size_t>(part.group)].branches[0],
              state.groups[static_cast<std::size_t>(part.group)].branches[0], x);
    for (int k = 0; part.kind != PartKind::group && k < size_of(part); ++k)
      x.push_back(state.x[part.column + k]);
  }
}

// What condensing the chain gives at coordinates `x` under `F`, and its coordinates after a step.
struct Condensed {
  Matrix6 K;
  Vector6 dF;
  Eigen::VectorXd next;
};

Condensed condensed_at(const Machine& machine, const Eigen::VectorXd& x, const Vector6& F,
                       const Vector6& dxi) {
  const Model model = prepare(machine);
  const Units units{model.mechanism.length};
  const Series& chain = model.mechanism.chains[0];
  SeriesWork work = make_work(chain);
  SeriesState state = zero_configuration(model.mechanism).chains[0];
  int next = 0;
  const Pose end = fill(chain, x, next, state);
  REQUIRE(next == x.size());
  state.F = F;
  const Pose wanted = moved(end, 0.1 * dxi);
  for (int level = 0; level < 3; ++level) {
    evaluate(chain, state, wanted, {}, model.mechanism.gravity, Hessians::yes, work);
    if (level < 2) balance(chain, work, state);  // outer groups first: inner ones carry what they do
  }
  REQUIRE(condense(chain, units, work));
  take_step(chain, dxi, Vector3::Zero(), units, work, state);
  std::vector<double> after;
  collect(chain, state, after);
  return {work.K, work.dF,
          Eigen::Map<const Eigen::VectorXd>(after.data(), static_cast<Eigen::Index>(after.size()))};
}

}  // namespace

TEST_CASE(
    "elements set apart as a branch condense to the same stiffness, wrench and step, however heavy and "
    "unbalanced") {
  const Robots all = robots(3000);
  for (unsigned seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    Random random(400 + seed);
    Eigen::VectorXd x(6 + 6 + 6);
    for (double& value : x) value = 0.4 * random.number();
    const Vector6 F = random.six(5000, 2000), dxi = random.six(1e-2, 1e-2);
    const Condensed expected = condensed_at(all.plain, x, F, dxi);
    for (const Machine* machine : {&all.forearm, &all.joints, &all.nested}) {
      CAPTURE(machine->chains[0].elements.size());
      const Condensed apart = condensed_at(*machine, x, F, dxi);
      CHECK((apart.K - expected.K).norm() < 1e-9 * expected.K.norm());
      CHECK((apart.dF - expected.dF).norm() < 1e-9 * expected.dF.norm());
      CHECK((apart.next - expected.next).cwiseAbs().maxCoeff() < 1e-9);
    }
  }
}

TEST_CASE(
    "elements set apart as a branch leave a machine's equilibrium, target, stiffness and condition as they "
    "were") {
  const Robots all = robots(60);
  const Load load{(Vector6() << 300, -200, 400, 20, 30, -10).finished(), false};
  const Model reference = prepare(all.plain);
  StaticsWork work(reference.mechanism);
  const Pose X_MT = tip(reference.mechanism, reference.home);
  const Equilibrium forward = solve_forward(reference, reference.home, load, {}, work);
  const Equilibrium target = solve_target(reference, reference.home, X_MT, load, {}, work);
  const Matrix6 K = stiffness(reference, forward.configuration, {}, work).K;
  REQUIRE(target.status == Status::converged);
  for (const Machine* machine : {&all.forearm, &all.joints, &all.nested}) {
    const Model model = prepare(*machine);
    CAPTURE(model.mechanism.chains[0].columns);
    CHECK(model.mechanism.chains[0].groups.at(0).branches.at(0).leans);
    StaticsWork inner(model.mechanism);
    const Equilibrium a = solve_forward(model, model.home, load, {}, inner);
    const Equilibrium b = solve_target(model, model.home, X_MT, load, {}, inner);
    REQUIRE(a.status == Status::converged);
    REQUIRE(b.status == Status::converged);
    CHECK(difference(a.configuration.X_MP, forward.configuration.X_MP).norm() < 1e-10);
    CHECK((actuator_values(model.mechanism, b.configuration) -
           actuator_values(reference.mechanism, target.configuration))
              .cwiseAbs()
              .maxCoeff() < 1e-10);
    CHECK((stiffness(model, a.configuration, {}, inner).K - K).norm() < 1e-7 * K.norm());
    CHECK(stability(model, a.configuration, load, {}, inner) > 0);
  }
}

TEST_CASE("a leaning branch's share in a collapse is that of the same elements in its chain") {
  // Soft joints, each under a mass; the upper half may be in a branch of its own, and with the next in
  // another.
  const auto column = [](double kg, int groups) {
    const std::string lower =
        "{ spring = \"soft\" }, { rigid = { xyz_mm = [0, 0, 300] }, mass = { kg = $, at_mm = [0, 0, 50] } "
        "}, ";
    std::string text = fmt::format(
        "controlled = []\ngravity_m_s2 = [0, 0, -9.81]\n[springs.soft]\nstiffness_diag_si = [4e3, 4e3, 1e5, "
        "300, 400, "
        "500]\n[[chain]]\nname = \"column\"\nelements = [{0}{0}{0}{0}]",
        lower);
    for (std::size_t at; (at = text.find('$')) != std::string::npos;)
      text.replace(at, 1, fmt::format("{}", kg));
    Machine machine = read_machine("format = \"counterflex-machine 1\"\n" + text, "column.toml");
    if (groups > 0) machine = set_apart(machine, 6, 12);
    if (groups > 1) machine = set_apart(machine, 3, 7);
    return prepare(machine);
  };
  const auto judge = [&](double kg, int groups) {
    const Model model = column(kg, groups);
    StaticsWork work(model.mechanism);
    return stability(model, model.home, {}, {}, work) > 0;
  };
  const auto status = [&](double kg, int groups) {
    const Model model = column(kg, groups);
    StaticsWork work(model.mechanism);
    return solve_forward(model, model.home, {}, {}, work).status;
  };
  double below = 1, above = 1000;
  while (above - below > 1e-5) {
    const double middle = (below + above) / 2;
    (judge(middle, 0) ? below : above) = middle;
  }
  for (const int groups : {0, 1, 2}) {
    CAPTURE(groups);
    CHECK(judge(0.9999 * below, groups));
    CHECK_FALSE(judge(1.0001 * above, groups));
    CHECK(status(0.9 * below, groups) == Status::converged);
    CHECK(status(1.1 * above, groups) == Status::unstable);
  }
}
