#include "compensation/plan/corrections.hpp"

#include "compensation/solve/failures.hpp"

namespace counterflex {

Answer Corrections::ask(std::size_t segment, double u, Side side) {
  const Segment& on = job_.path.segments[segment];
  const bool joins = u == 0 && !requests_.empty() && segments_.back() + 1 == segment &&
                     job_.forces.follows(segment) && requests_.back().p_MT == on.wanted.start &&
                     requests_.back().R_MT == orientation_at(on, 0) &&
                     requests_.back().model == &model_of(job_, on) &&
                     requests_.back().directions == directions_at(job_, on.move, 0, side);
  return joins ? requests_.size() - 1 : ask(segment, u, force_at(segment, u, side), side);
}

Answer Corrections::ask(std::size_t segment, double u, const Vector6& F, Side side) {
  const Segment& on = job_.path.segments[segment];
  const TargetRequest request{&model_of(job_, on), point_at(on.wanted, u), F, orientation_at(on, u),
                              directions_at(job_, on.move, u, side)};
  const bool same = !requests_.empty() && requests_.back().model == request.model &&
                    requests_.back().p_MT == request.p_MT && requests_.back().R_MT == request.R_MT &&
                    requests_.back().F == F && requests_.back().directions == request.directions;
  if (same) return requests_.size() - 1;
  requests_.push_back(request);
  segments_.push_back(segment);
  return requests_.size() - 1;
}

std::optional<Failure> Corrections::failure_of(Answer a) const {
  const Segment& segment = job_.path.segments[segments_[a]];
  const TargetAnswer& answer = answers_[a];
  if (answer.status != Status::converged) return status_failure(job_, answer.status, segment, answer.target);
  if (auto failure = turn_limit_failure(job_, answer.turn, segment.line)) return failure;
  const Vector3 shift = shift_of(correction(a)) + job_.path.frames[segment.frame].datum_shift;
  return limit_failure(job_, shift, segment.line);
}

void Corrections::solve() {
  const std::size_t first = answers_.size();
  answers_.resize(requests_.size());
  solver_.targets(std::span(requests_).subspan(first), std::span(answers_).subspan(first));
  for (Answer a = first; a < answers_.size(); ++a) {
    if (segments_[a] >= end_) continue;
    auto failure = failure_of(a);
    if (!failure) continue;
    failure_ = std::move(failure);
    end_ = segments_[a];
  }
}

}  // namespace counterflex
