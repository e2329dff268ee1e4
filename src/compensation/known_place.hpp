#pragma once
/// What planning has found of the tip along a segment, for verification, which asks the same.
#include "counterflex/program/rare.hpp"
#include "path_solver.hpp"

namespace counterflex {

/// Where the tip stands for one command: an equilibrium solved forward, as good as any.
struct KnownTip {
  Vector3 command = Vector3::Zero();  ///< M (m)
  Pose X_MT;
  int iterations = 0;
  bool known = false;
};

/// At a place of the path, with everything acting: the command of the original program, and the one that was
/// foreseen to be written. What they were asked with is kept, so that they answer that question and no other:
/// a command that is written otherwise than foreseen is solved anew.
struct KnownPlace {
  Load load;
  KnownTip before, after;

  /// The answer to a request, equal to the last bit; null where it was not solved.
  const KnownTip* answer(const Vector3& command, const Load& asked) const {
    if (asked.F != load.F || asked.at_platform != load.at_platform) return nullptr;
    for (const KnownTip* tip : {&after, &before})
      if (tip->known && tip->command == command) return tip;
    return nullptr;
  }
};

struct KnownSegment {
  KnownPlace end;
  Rare<KnownPlace> inside;  ///< where it was looked into
};

}  // namespace counterflex
