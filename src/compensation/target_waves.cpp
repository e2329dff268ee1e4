#include "target_waves.hpp"

#include "commands.hpp"
#include "counterflex/compensation/waypoint.hpp"
#include "track.hpp"

namespace counterflex {

void TargetWaves::clear(std::size_t requests) {
  requests_.clear();
  solutions_.clear();
  segments_.clear();
  last_ = no_answer;
  failure_.reset();
  requests_.reserve(requests);
  solutions_.reserve(requests);
  segments_.reserve(requests);
}

Answer TargetWaves::add(std::size_t segment, const Vector3& p_MT, const Vector6& F) {
  requests_.push_back({p_MT, {F, job_.forces.at_platform()}});
  segments_.push_back(segment);
  return requests_.size() - 1;
}

Answer TargetWaves::ask(std::size_t segment, double u, Side side) {
  const Vector3 p_MT = point_at(job_.path.segments[segment].wanted, u);
  const bool same_place = last_ != no_answer && requests_[last_].p_MT == p_MT;
  const bool follows = same_place && u == 0 && segments_[last_] + 1 == segment;
  if (follows && job_.forces.follows(segment)) return last_;
  const Vector6 F = force_at(segment, u, side);
  if (!same_place || requests_[last_].load.F != F) last_ = add(segment, p_MT, F);
  return last_;
}

Answer TargetWaves::ask_end(std::size_t segment, const Vector6& F) {
  const Vector3 p_MT = point_at(job_.path.segments[segment].wanted, 1);
  if (last_ != no_answer && requests_[last_].p_MT == p_MT && requests_[last_].load.F == F) return last_;
  last_ = add(segment, p_MT, F);
  return last_;
}

Answer TargetWaves::ask_inside(std::size_t segment, double u) {
  const Vector3 p_MT = point_at(job_.path.segments[segment].wanted, u);
  return add(segment, p_MT, force_at(segment, u, Side::before));
}

Answer TargetWaves::ask_apart(std::size_t segment, const Vector6& F) {
  return add(no_segment, point_at(job_.path.segments[segment].wanted, 1), F);
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
    failure_ = status_failure(job_, status(a), solver_.model(), job_.program.moves[segment.move],
                              solutions_[a].target, segment.line);
  else
    failure_ = limit_failure(job_, correction(a) + job_.path.frames[segment.frame].datum_shift, segment.line);
  return !failure_;
}

}  // namespace counterflex
