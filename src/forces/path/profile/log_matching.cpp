#include "forces/path/profile/log_matching.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace counterflex {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();

// Sums that differ by less than this fraction of the searched distance squared are equal.
constexpr double equal_sums = 1e-9;

/// The least sum up to a visit, and its predecessor: a visit of the row above.
struct Best {
  double sum = impossible;
  std::uint32_t from = 0;
};

/// The least sums of the visits of one row, from those of the row above.
class Step {
 public:
  Step(const std::vector<Visit>& above, const std::vector<Best>& best, double within)
      : above_(above), best_(best), within_(within), equal_(equal_sums * within * within) {}

  /// For visits in order.
  Best to(const Visit& visit) {
    for (; next_ < above_.size() && above_[next_].s <= visit.s; ++next_)
      take(best_[next_].sum, next_, least_);
    Best best = least_;
    for (std::size_t u = next_; u < above_.size() && above_[u].s <= visit.s + within_; ++u) {
      const double back = above_[u].s - visit.s;
      if (best_[u].sum + back * back < best.sum - equal_) best = {best_[u].sum + back * back, index(u)};
    }
    best.sum += visit.squared;
    return best;
  }

 private:
  static std::uint32_t index(std::size_t u) { return static_cast<std::uint32_t>(u); }

  // The latest of equal ones is the nearest.
  void take(double sum, std::size_t u, Best& best) const {
    if (sum <= best.sum + equal_ && sum < impossible) best = {std::min(sum, best.sum), index(u)};
  }

  const std::vector<Visit>& above_;
  const std::vector<Best>& best_;
  double within_, equal_;
  std::size_t next_ = 0;
  Best least_;
};

std::vector<Best> first_row(const std::vector<Visit>& visits) {
  std::vector<Best> best;
  for (const Visit& visit : visits) best.push_back({visit.squared, 0});
  return best;
}

bool all_impossible(const std::vector<Best>& best) {
  return std::all_of(best.begin(), best.end(), [](const Best& b) { return b.sum == impossible; });
}

/// The earliest of the least.
std::size_t end_of(const std::vector<Best>& best, double within) {
  std::size_t end = 0;
  for (std::size_t v = 1; v < best.size(); ++v)
    if (best[v].sum < best[end].sum - equal_sums * within * within) end = v;
  return end;
}

}  // namespace

OrderedPlaces in_order(const std::vector<std::vector<Visit>>& rows, double within) {
  OrderedPlaces places;
  std::vector<std::vector<Best>> best;
  best.reserve(rows.size());  // a step reads the row above
  best.push_back(first_row(rows.front()));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    Step step(rows[i - 1], best.back(), within);
    std::vector<Best>& here = best.emplace_back();
    for (const Visit& visit : rows[i]) here.push_back(step.to(visit));
    if (all_impossible(here)) return {{}, i};
  }
  places.s.resize(rows.size());
  std::size_t v = end_of(best.back(), within);
  for (std::size_t i = rows.size(); i-- > 0; v = best[i].empty() ? 0 : best[i][v].from)
    places.s[i] = rows[i][v].s;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (places.s[i - 1] - places.s[i] > within) return {{}, i};
    places.s[i] = std::max(places.s[i], places.s[i - 1]);
  }
  return places;
}

}  // namespace counterflex
