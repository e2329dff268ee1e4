#include <fmt/format.h>

#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {
namespace {

// Of a cut of immersion phi the mean force along the feed is proportional to
//
//     k_t sin^2 phi / 2 - k_r (2 phi - sin 2 phi) / 4     in climb milling
//     -k_t sin^2 phi / 2 - k_r (2 phi - sin 2 phi) / 4    in conventional milling
// With k_r = 0.3 k_t it pushes the tool along its feed in climb milling up to three quarters of the diameter,
// never in slots, conventional milling and drilling. Programs contain some of these, and entries. A force of
// the wrong sense pushes nearly everywhere.
constexpr double most_along = 0.75;  // share of the path with a force

// A force that is given in the machine's axes keeps its direction while the feed turns: the mean of its
// vectors is as large as the mean of their sizes, the mean direction of the feed is far from 1.
constexpr double same_direction = 0.999, turning_feed = 0.5;

}  // namespace

void FeedForceTally::add(const Waypoint& w) {
  if (!w.cutting || w.status != Status::converged || w.weight <= 0) return;
  const Vector3 F = w.wrench.head<3>();
  if (F.isZero(0) || w.direction.isZero(0)) return;
  const double component = F.dot(w.direction);
  loaded += w.weight;
  direction += w.weight * w.direction;
  const Vector3 across = F - F.dot(w.tool_axis) * w.tool_axis;
  force += w.weight * across;
  size += w.weight * across.norm();
  if (component <= 0) return;
  along += w.weight;
  push += w.weight * component;
}

SanityCheck check_feed_force(const FeedForceTally& tally, bool computed,
                             const std::optional<Failure>& failure) {
  if (tally.loaded <= 0 && failure) return {"feed force", SanityState::unknown, unknown_behind(*failure)};
  if (tally.loaded <= 0) return {"feed force", SanityState::ok, "no force acts on a feed move"};
  const double share = tally.along / tally.loaded;
  const std::string percent = format_fixed(100 * share, 0);
  if (!computed && tally.size > 0 && tally.force.norm() > same_direction * tally.size &&
      tally.direction.norm() < turning_feed * tally.loaded)
    return {
        "feed force", SanityState::doubtful,
        fmt::format("the force keeps its direction in the machine while the feed turns (it pushes along the "
                    "feed on {} % of the path); a cutting force turns with the feed: give a force profile "
                    "in the frame of the path",
                    percent)};
  if (!computed && share > most_along)
    return {
        "feed force", SanityState::doubtful,
        fmt::format("the force pushes the tool along the feed on {} % of the path (mean +{} N): is the sense "
                    "right? Climb milling narrower than 3/4 of the diameter does this, slots and "
                    "conventional milling do not",
                    percent, format_fixed(tally.push / tally.along, 0))};
  return {"feed force", SanityState::ok,
          tally.along > 0 ? fmt::format("pushes the tool along the feed on {} % of the path (mean +{} N)",
                                        percent, format_fixed(tally.push / tally.along, 0))
                          : "acts against the feed, or across it, on the whole path"};
}

}  // namespace counterflex
