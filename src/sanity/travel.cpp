#include <fmt/format.h>

#include <algorithm>

#include "counterflex/sanity/checks.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

namespace {

void add_value(AxisValues& range, const Travel& travel, double value, int line) {
  constexpr double indistinct = 1e-9;  // m, rad
  range.least = std::min(range.least, value);
  range.largest = std::max(range.largest, value);
  const double margin = std::min(value - travel.min, travel.max - value);
  if (!(margin < range.margin - indistinct)) return;  // keeps the first of equal values
  range.margin = margin;
  range.line = line;
}

}  // namespace

void TravelTally::add(const Mechanism& mechanism, const Eigen::VectorXd& rho, int line) {
  last_ = rho + full_turns(mechanism, rho, places_++ == 0 ? rho : last_);
  axes_.resize(mechanism.travel.size());
  for (std::size_t i = 0; i < axes_.size(); ++i)
    add_value(axes_[i], mechanism.travel[i],
              shown_value(mechanism.shown, static_cast<Eigen::Index>(i), last_.data()), line);
  const auto at = tightest_axis(mechanism, last_);
  if (!at) return;
  if (tightest_ && at->share >= share_ - 1e-9) return;  // keeps the first of equal values
  tightest_ = LeastMargin{at->actuator, at->value, at->margin, line};
  share_ = at->share;
}

namespace {

std::string skipped_words(const TravelTally& tally) {
  const std::size_t count = tally.skipped();
  if (count == 0) return "";
  return fmt::format("; not judged: {} move{} to places that are not known, the first in line {}", count,
                     count == 1 ? "" : "s", tally.first_skipped());
}

}  // namespace

std::string unknown_behind(const Failure& failure) {
  return failure.line > 0 ? fmt::format("unknown after line {}, where the run ended", failure.line)
                          : "unknown: the run ended early";
}

SanityCheck check_travel(const Mechanism& named, const TravelTally& tally,
                         const std::optional<Failure>& failure) {
  if (failure && failure->status == Status::outside_travel)
    return {"travel", SanityState::doubtful, fmt::format("line {}: {}", failure->line, failure->what)};
  if (failure) return {"travel", SanityState::unknown, unknown_behind(*failure)};
  const auto least = tally.least();
  if (!least)
    return {"travel", SanityState::unknown,
            tally.places() == 0 ? "no place of the path was solved"
                                : "no actuator has a travel in the machine file"};
  const Travel& travel = named.travel[least->actuator];
  if (least->margin < 0)
    return {"travel", SanityState::doubtful,
            fmt::format("line {}: {}", least->line, outside_travel_words(travel, least->value))};
  return {"travel", SanityState::ok,
          fmt::format("least margin {} on {}, rapids included: {} at line {}, travel {}{}",
                      axis_value(travel, least->margin), travel.name, axis_value(travel, least->value),
                      least->line, travel_range(travel), skipped_words(tally))};
}

}  // namespace counterflex
