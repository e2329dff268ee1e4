#include "target_waves.hpp"

#include "counterflex/compensation/waypoint.hpp"
#include "track.hpp"

namespace counterflex {

void TargetWaves::clear(std::size_t requests) {
  requests_.clear();
  solutions_.clear();
  segments_.clear();
  failure_.reset();
  requests_.reserve(requests);
  solutions_.reserve(requests);
  segments_.reserve(requests);
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

Answer TargetWaves::ask_again(Answer answer, const Vector6& F) {
  requests_.push_back({requests_[answer].p_MT, {F, job_.forces.at_platform()}});
  segments_.push_back(no_segment);
  return requests_.size() - 1;
}

bool TargetWaves::solve() {
  const std::size_t first = solutions_.size();
  solutions_.resize(requests_.size());
  solver_.targets(std::span(requests_).subspan(first), std::span(solutions_).subspan(first));
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
