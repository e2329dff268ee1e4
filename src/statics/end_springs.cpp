#include "end_springs.hpp"

#include <algorithm>

#include "series.hpp"

namespace counterflex {
namespace {

constexpr int of_spring = 6;  // coordinates

void add_end_spring(const Units& units, Series& series) {
  Part spring{.kind = PartKind::spring, .column = series.columns};
  spring.K.diagonal() = units.energy() * units.of_pose().cwiseAbs2().cwiseInverse();
  for (int i = 0; i < of_spring; ++i) {
    series.free.push_back(series.columns++);
    series.angular.push_back(i >= 3);
  }
  series.parts.push_back(spring);
}

}  // namespace

bool is_rigid(const Mechanism& mechanism) {
  return mechanism.stiffest == 0 &&
         std::all_of(mechanism.chains.begin(), mechanism.chains.end(), [](const Series& chain) {
           return std::all_of(chain.parts.begin(), chain.parts.end(), [](const Part& part) {
             return part.kind != PartKind::spring && part.kind != PartKind::compliance &&
                    part.kind != PartKind::group;
           });
         });
}

Model with_end_springs(const Model& rigid) {
  Model model = rigid;
  model.mechanism.gravity.setZero();  // weights do not move it either
  const Units units{rigid.mechanism.length};
  for (Series& chain : model.mechanism.chains) add_end_spring(units, chain);
  model.mechanism.stiffest = units.energy() / (units.length * units.length);
  for (SeriesState& chain : model.home.chains)
    for (Eigen::VectorXd* x : {&chain.x, &chain.x_nominal}) {
      x->conservativeResize(x->size() + of_spring);
      x->tail<of_spring>().setZero();
    }
  return model;
}

Configuration without_end_springs(Configuration configuration) {
  for (SeriesState& chain : configuration.chains)
    for (Eigen::VectorXd* x : {&chain.x, &chain.x_nominal}) x->conservativeResize(x->size() - of_spring);
  return configuration;
}

}  // namespace counterflex
