#pragma once
/// States far from equilibrium, for laws that hold anywhere; and how far two states are apart.
#include "statics/support/laws_support.hpp"

namespace counterflex::laws {

/// Everything turned and moved: springs by rotation vectors of 0.3 rad, joints by up to half a radian or half
/// a metre, groups anywhere, times `size`; the wrench is random up to (500 N, 200 N m) times `wrench`.
inline SeriesState shaken(const Series& series, SeriesState state, Random& random, double size = 1,
                          double wrench = 1) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::spring) {
      state.x.segment<6>(part.column) << random.vector(0.05 * size),
          random.vector(1).normalized() * 0.3 * size;
    } else if (part.kind == PartKind::group) {
      GroupState& group = state.groups[static_cast<std::size_t>(part.group)];
      group.X = moved(group.X, random.six(0.3 * size, 0.7 * size));
      for (std::size_t b = 0; b < group.branches.size(); ++b)
        group.branches[b] = shaken(series.groups[static_cast<std::size_t>(part.group)].branches[b],
                                   group.branches[b], random, size, wrench);
    } else if (part.column >= 0) {
      state.x[part.column] += 0.5 * size * random.number();
    }
  }
  state.F = random.six(500 * wrench, 200 * wrench);
  return state;
}

inline Configuration shaken(const Mechanism& mechanism, Configuration configuration, Random& random,
                            double size, double wrench) {
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i)
    configuration.chains[i] = shaken(mechanism.chains[i], configuration.chains[i], random, size, wrench);
  configuration.X_MP = moved(configuration.X_MP, random.six(0.1 * size, 0.3 * size));
  return configuration;
}

/// Of all coordinates (m, rad), in all branches.
inline double largest_difference(const SeriesState& a, const SeriesState& b) {
  double largest = (a.x - b.x).cwiseAbs().maxCoeff();
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    largest = std::max(largest, difference(a.groups[g].X, b.groups[g].X).norm());
    for (std::size_t i = 0; i < a.groups[g].branches.size(); ++i)
      largest = std::max(largest, largest_difference(a.groups[g].branches[i], b.groups[g].branches[i]));
  }
  return largest;
}

inline double largest_difference(const Configuration& a, const Configuration& b) {
  double largest = difference(a.X_MP, b.X_MP).norm();
  for (std::size_t i = 0; i < a.chains.size(); ++i)
    largest = std::max(largest, largest_difference(a.chains[i], b.chains[i]));
  return largest;
}

}  // namespace counterflex::laws
