#include "target_waves.hpp"

#include "commands.hpp"
#include "counterflex/compensation/waypoint.hpp"
#include "track.hpp"

namespace counterflex {

void TargetWaves::clear(std::size_t requests) {
  requests_.clear();
  solutions_.clear();
  segments_.clear();
  number_through_.clear();
  through_.clear();
  fractions_.clear();
  known_.clear();
  last_ = no_answer;
  failure_.reset();
  requests_.reserve(requests);
  solutions_.reserve(requests);
  segments_.reserve(requests);
  number_through_.reserve(requests);
  if (!has_lanes_for_targets(job_)) return;
  through_.reserve(requests);
  fractions_.reserve(requests);
  known_.reserve(requests);
}

Answer TargetWaves::add(std::size_t segment, const Vector3& p_MT, const Vector6& F) {
  requests_.push_back({p_MT, {F, job_.forces.at_platform()}});
  segments_.push_back(segment);
  number_through_.push_back(none_through);
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
  ask_through(last_, 1);
  return last_;
}

Answer TargetWaves::ask_inside(std::size_t segment, double u) {
  const Vector3 p_MT = point_at(job_.path.segments[segment].wanted, u);
  const Answer inside = add(segment, p_MT, force_at(segment, u, Side::before));
  ask_through(inside, u);
  return inside;
}

Answer TargetWaves::ask_apart(std::size_t segment, const Vector6& F) {
  return add(no_segment, point_at(job_.path.segments[segment].wanted, 1), F);
}

void TargetWaves::ask_through(Answer a, double u) {
  if (!has_lanes_for_targets(job_)) return;
  number_through_[a] = through_.size();
  const std::size_t frame = job_.path.segments[segments_[a]].frame;
  through_.push_back({a, original_command(job_, frame, requests_[a].p_MT)});
  fractions_.push_back(u);
}

const KnownPlace& TargetWaves::known(Answer a) const {
  static const KnownPlace nothing;
  return number_through_[a] == none_through ? nothing : known_[number_through_[a]];
}

bool TargetWaves::solve() {
  const std::size_t first = solutions_.size(), first_through = known_.size();
  solutions_.resize(requests_.size());
  known_.resize(through_.size());
  wave_.assign(through_.begin() + static_cast<std::ptrdiff_t>(first_through), through_.end());
  for (ThroughRequest& one : wave_) one.target -= first;
  const auto foreseen = [&](std::size_t i, const Vector3& target) {
    const std::size_t segment = segments_[first + wave_[i].target];
    const double u = fractions_[first_through + i];
    return u == 1 ? foresight_.foresee_end(segment, target) : foresight_.inside(segment, u);
  };
  solver_.targets(std::span(requests_).subspan(first), wave_, foreseen, std::span(solutions_).subspan(first),
                  std::span(known_).subspan(first_through));
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
