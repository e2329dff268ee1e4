#pragma once
/// What the text will command, told before it is written.
#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// Foresees what is commanded along segments, one after another along the path: their ends in words rounded
/// to their digits, as emission has them written, and the lines between them. Where it does not know what the
/// text holds before a move, or where points are inserted, it may be wrong; who uses it compares.
class Foresight {
 public:
  explicit Foresight(const Job& job) : job_(&job) {}

  /// The command (M, m) with which a segment ends whose target is `target` (M, m); no number where it cannot
  /// be foreseen.
  Vector3 foresee_end(std::size_t segment, const Vector3& target);

  /// The command at a fraction of the line of which the end was foreseen last; no number for another segment.
  Vector3 inside(std::size_t segment, double u) const;

 private:
  HeldPosition before(std::size_t segment) const;
  Vector3 command(std::size_t segment, const HeldPosition& held) const;

  const Job* job_;
  std::size_t last_ = no_segment;
  HeldPosition before_{}, held_{};                   // of the text, before and behind it
};

}  // namespace counterflex
