#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "counterflex/sanity/checks.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

namespace {

void add_value(AxisValues& range, const Travel& travel, double value, int line) {
  constexpr double indistinct = 1e-9;  // m, rad
  range.least = std::min(range.least, value);
  range.largest = std::max(range.largest, value);
  const double nearer = std::min(value - travel.min, travel.max - value),
               margin = std::abs(nearer) < indistinct ? 0 : nearer;
  if (!(margin < range.margin - indistinct)) return;  // keeps the first of equal values
  range.margin = margin;
  range.tightest = margin == 0 ? std::clamp(value, travel.min, travel.max) : value;
  range.line = line;
}

}  // namespace

void TravelTally::add(const Mechanism& mechanism, const Eigen::VectorXd& rho, int line) {
  last_ = rho + full_turns(mechanism, rho, places_++ == 0 ? rho : last_);
  axes_.resize(mechanism.travel.size());
  for (std::size_t i = 0; i < axes_.size(); ++i)
    add_value(axes_[i], mechanism.travel[i],
              shown_value(mechanism.shown, static_cast<Eigen::Index>(i), last_.data()), line);
}

namespace {

std::string skipped_words(const TravelTally& tally) {
  const std::size_t count = tally.skipped();
  if (count == 0) return "";
  return fmt::format("; not judged: {} move{} to places that are not known, the first in line {}", count,
                     count == 1 ? "" : "s", tally.first_skipped());
}

/// The actuator of a kind that comes nearest to an end of its travel.
struct LeastMargin {
  const Travel& travel;
  const AxisValues& axis;
};

/// None: no actuator of the kind has a limit, or no place was added.
std::optional<LeastMargin> least_margin(const Mechanism& named, const TravelTally& tally, JointKind kind) {
  const std::vector<AxisValues>& axes = tally.axes();
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (named.travel[i].kind == kind && axes[i].margin < (found ? axes[*found].margin : HUGE_VAL)) found = i;
  if (!found) return std::nullopt;
  return LeastMargin{named.travel[*found], axes[*found]};
}

std::string words_of(const LeastMargin& least, std::string_view between) {
  const auto& [travel, axis] = least;
  return fmt::format("{} on {}{}: {} at line {}, travel {}", axis_value(travel, axis.margin), travel.name,
                     between, axis_value(travel, axis.tightest), axis.line, travel_range(travel));
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
  std::string words;
  for (const JointKind kind : {JointKind::prismatic, JointKind::revolute}) {
    const auto least = least_margin(named, tally, kind);
    if (!least) continue;
    if (const auto& [travel, axis] = *least; axis.margin < 0)
      return {"travel", SanityState::doubtful,
              fmt::format("line {}: {}", axis.line, outside_travel_words(travel, axis.tightest))};
    words += words.empty() ? "least margin " + words_of(*least, ", rapids included")
                           : "; of rotary axes " + words_of(*least, "");
  }
  if (words.empty())
    return {"travel", SanityState::unknown,
            tally.places() == 0 ? "no place of the path was solved"
                                : "no actuator has a travel in the machine file"};
  return {"travel", SanityState::ok, words + skipped_words(tally)};
}

}  // namespace counterflex
