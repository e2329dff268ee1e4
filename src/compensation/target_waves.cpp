#include "target_waves.hpp"

#include <algorithm>

#include "counterflex/compensation/waypoint.hpp"
#include "track.hpp"

namespace counterflex {

void TargetWaves::clear(std::size_t requests) {
  requests_.clear();
  solutions_.clear();
  segments_.clear();
  ends_.clear();
  known_.clear();
  failure_.reset();
  requests_.reserve(requests);
  solutions_.reserve(requests);
  segments_.reserve(requests);
  ends_.reserve(requests);
  known_.reserve(requests);
}

Answer TargetWaves::ask(std::size_t segment, double u, Side side) {
  const Vector3 p_MT = point_at(job_.path.segments[segment].wanted, u);
  const bool same_place =
      !requests_.empty() && segments_.back() != no_segment && requests_.back().p_MT == p_MT;
  const bool follows = same_place && u == 0 && segments_.back() + 1 == segment;
  if (follows && job_.forces.follows(segment)) return requests_.size() - 1;
  const Vector6 F = force_at(segment, u, side);
  if (!same_place || requests_.back().load.F != F) {
    requests_.push_back({p_MT, {F, job_.forces.at_platform()}});
    segments_.push_back(segment);
  }
  return requests_.size() - 1;
}

Answer TargetWaves::ask_end(std::size_t segment) {
  const std::size_t before = requests_.size();
  const Answer end = ask(segment, 1, Side::before);
  if (end < before) return end;
  const Vector3& datum_shift = job_.path.frames[job_.path.segments[segment].frame].datum_shift;
  ends_.push_back({end, requests_[end].p_MT - datum_shift});
  return end;
}

KnownEnd TargetWaves::known_end(Answer a) const {
  const auto found =
      std::lower_bound(ends_.begin(), ends_.end(), a,
                       [](const EndRequest& end, Answer answer) { return end.target < answer; });
  if (found == ends_.end() || found->target != a) return {};
  return known_[static_cast<std::size_t>(found - ends_.begin())];
}

Answer TargetWaves::ask_again(Answer answer, const Vector6& F) {
  requests_.push_back({requests_[answer].p_MT, {F, job_.forces.at_platform()}});
  segments_.push_back(no_segment);
  return requests_.size() - 1;
}

bool TargetWaves::solve() {
  const std::size_t first = solutions_.size(), first_end = known_.size();
  solutions_.resize(requests_.size());
  known_.resize(ends_.size());
  wave_.assign(ends_.begin() + static_cast<std::ptrdiff_t>(first_end), ends_.end());
  for (EndRequest& end : wave_) end.target -= first;
  solver_.targets(
      std::span(requests_).subspan(first), wave_,
      [&](std::size_t i, const Vector3& target) {
        return foresight_.command(segments_[first + wave_[i].target], target);
      },
      std::span(solutions_).subspan(first), std::span(known_).subspan(first_end));
  for (std::size_t i = first; i < solutions_.size(); ++i)
    if (segments_[i] != no_segment && !check(i)) return false;
  return true;
}

bool TargetWaves::check(Answer a) {
  const Segment& segment = job_.path.segments[segments_[a]];
  if (status(a) != Status::converged)
    failure_ = status_failure(status(a), segment.line);
  else
    failure_ = limit_failure(job_, correction(a) + job_.path.frames[segment.frame].datum_shift, segment.line);
  return !failure_;
}

}  // namespace counterflex
