#pragma once
/// Machines with masses everywhere, and the Newton steps that tests of them take.
#include <Eigen/LU>

#include "model/part.hpp"
#include "statics/support/laws_states.hpp"
#include "theory/manipulator.hpp"

namespace counterflex::laws {

inline const Vector3 tilted_gravity(2.1, -3.4, -8.9);  // m/s2

/// A point mass of up to `kg` after every element, those of branches included, anywhere within 150 mm.
inline void add_masses(std::vector<Element>& elements, double kg, Random& random) {
  std::vector<Element> heavy;
  for (Element& element : elements) {
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) add_masses(branch.elements, kg, random);
    heavy.push_back(element);
    heavy.push_back(PointMass{kg * (0.55 + 0.45 * random.number()), random.vector(0.15)});
  }
  elements = std::move(heavy);
}

inline Machine heavy(Machine machine, double kg, unsigned seed = 5) {
  Random random(seed);
  for (Chain& chain : machine.chains) add_masses(chain.elements, kg, random);
  machine.gravity.g = tilted_gravity;
  return machine;
}

/// Energy of the weights of a series (J), zero where its start frame is: -sum m g . p. `g` (m/s2) in axes of
/// that frame.
inline double weight_energy(const Series& series, const SeriesState& state, const Stage& stage,
                            const Vector3& g) {
  double energy = 0;
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::mass) energy -= part.mass * g.dot(X * part.X.p);
    if (part.kind == PartKind::group)
      for (std::size_t b = 0; b < series.groups[part.group].branches.size(); ++b) {
        const Series& branch = series.groups[part.group].branches[b];
        energy += weight_energy(branch, state.groups[part.group].branches[b], stage, X.R.transpose() * g) -
                  branch.mass * g.dot(X.p);
      }
    X = X * part_pose(part, state, stage);
  }
  return energy;
}

inline Model heavy_model_of(const std::string& name, double kg = 1, unsigned seed = 5) {
  return prepare(heavy(machine_of(name), kg, seed));
}

/// A Newton step by condensing chains: sum of stiffnesses, then every chain's own step. The works must be
/// evaluated.
inline Configuration condensed_step(const Model& model, Configuration c, const Problem& problem,
                                    const Units& units, StaticsWork::Impl& work) {
  const PlatformTerms terms = platform_terms(model, c, problem);
  Matrix6 K = terms.A;
  Vector6 rhs = -terms.gradient;
  for (std::size_t i = 0; i < work.chains.size(); ++i) {
    REQUIRE(condense(model.mechanism.chains[i], units, work.chains[i]));
    K += work.chains[i].K;
    rhs -= work.chains[i].dF;
  }
  const Vector6 dxi = K.fullPivLu().solve(rhs);
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    take_step(model.mechanism.chains[i], dxi, Vector3::Zero(), units, work.chains[i], c.chains[i]);
  c.X_MP = moved(c.X_MP, dxi);
  return c;
}

}  // namespace counterflex::laws
