#pragma once
/// Builds programs for tests of modules that need moves but no text.
#include <optional>

#include "counterflex/program/program.hpp"

namespace counterflex::test {

/// Appends moves from a known start; each has the next line, from line 1 on, and `program.text` an empty line
/// for it.
struct ProgramBuilder {
  Program program;
  Vector3 at_mm;
  std::optional<Vector6> force;

  explicit ProgramBuilder(const Vector3& start_mm) : at_mm(start_mm) { program.file = "part.ngc"; }

  ProgramBuilder& rapid(const Vector3& end_mm) { return add(Motion::rapid, end_mm, 0); }
  ProgramBuilder& feed(const Vector3& end_mm, double feed_mm_min) {
    return add(Motion::feed, end_mm, feed_mm_min);
  }

  /// An arc in G17, counter-clockwise unless `clockwise`.
  ProgramBuilder& arc(const Vector3& end_mm, const Vector3& centre_mm, double feed_mm_min,
                      bool clockwise = false) {
    return add(Motion::feed, end_mm, feed_mm_min).about(centre_mm, 2, clockwise);
  }

  /// Makes the last move an arc about an axis in direction `normal` (0, 1 or 2).
  ProgramBuilder& about(const Vector3& centre_mm, int normal, bool clockwise = false) {
    ArcMove arc;
    arc.normal = normal;
    arc.clockwise = clockwise;
    arc.centre_mm = centre_mm;
    program.moves.back().arc = arc;
    return *this;
  }

  /// As a comment (FORCE ...) before the next move.
  ProgramBuilder& with_force(const Vector6& F) {
    force = F;
    return *this;
  }

  /// N of the last move.
  ProgramBuilder& numbered(long n) {
    program.moves.back().block_number = n;
    return *this;
  }

 private:
  ProgramBuilder& add(Motion motion, const Vector3& end_mm, double feed_mm_min) {
    Move move;
    move.line = static_cast<int>(program.moves.size()) + 1;
    move.motion = motion;
    move.known_start = move.known_end = {true, true, true};
    move.start_mm = at_mm;
    move.end_mm = end_mm;
    move.feed_mm_min = feed_mm_min;
    move.force = force;
    program.moves.push_back(move);
    program.text += '\n';
    at_mm = end_mm;
    return *this;
  }
};

}  // namespace counterflex::test
