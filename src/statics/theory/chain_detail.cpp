#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/theory.hpp"
#include "statics/model/part.hpp"

namespace counterflex {
namespace {

constexpr Stage everything{};

struct Collector {
  ChainDetail& detail;

  void series(const Series& series, const SeriesState& state, const std::string& path) {
    int number = 0;
    for (const Part& part : series.parts) {
      if (part.kind == PartKind::mass) continue;
      const std::string element = path + std::to_string(++number);
      if (part.kind == PartKind::group) group(series, part, state, element);
      if (part.column < 0 || part.kind == PartKind::group) continue;
      if (path.empty()) list_row(part);
      visit_coordinates(part, state, everything, [&](const PartCoordinate& c) {
        detail.coordinates.push_back({element, part.kind, c.component, c.angular, c.value, c.change, c.load});
      });
    }
  }

  void group(const Series& series, const Part& part, const SeriesState& state, const std::string& element) {
    const auto& branches = series.groups[part.group].branches;
    for (std::size_t b = 0; b < branches.size(); ++b)
      this->series(branches[b], state.groups[part.group].branches[b], element + "/" + branches[b].name + "/");
  }

  // Rows of K_Cq and K_Ctheta are of the chain's own columns.
  void list_row(const Part& part) {
    const std::size_t next = detail.coordinates.size();
    if (part.kind == PartKind::passive) detail.passive.push_back(next);
    if (part.kind == PartKind::compliance) detail.elastic.push_back(next);
    for (std::size_t k = 0; part.kind == PartKind::spring && k < 6; ++k) detail.elastic.push_back(next + k);
  }
};

}  // namespace

std::vector<ChainDetail> chain_details(const Model& model, const Configuration& nominal,
                                       const Configuration& loaded, const Vector6& dt_P,
                                       const StiffnessPlace& stiff, StaticsWork& work) {
  const auto eps = chain_eps(model, nominal, everything, work);
  std::vector<ChainDetail> all;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    const Series& series = model.mechanism.chains[i];
    ChainDetail detail{.name = series.name, .wrench = loaded.chains[i].F, .eps = eps[i]};
    detail.stiffness = chain_stiffness(model, i, stiff.configuration.chains[i], stiff.stage, work);
    if (eps[i]) detail.dt = dt_P - *eps[i];
    detail.energy = elastic_energy(series, loaded.chains[i], everything);
    Collector{detail}.series(series, loaded.chains[i], "");
    all.push_back(std::move(detail));
  }
  return all;
}

}  // namespace counterflex
