#include "counterflex/compensation/significance.hpp"

#include <cstdint>

#include "compensation/solve/commands.hpp"

namespace counterflex {
namespace {

enum class Significance : std::uint8_t {
  corrected,  ///< above its band somewhere, not solved, or not to be left as programmed
  stands,     ///< it goes nowhere: the move before it counts
  may_stay,   ///< no sample yet
  below,      ///< below its band at all samples
};

/// What decides about the ends beside a move.
struct MoveSignificance {
  Significance is = Significance::corrected;
  bool may_fade = false;  ///< one of its ends may stay, and the other not
};

MoveSignificance before_samples(const Move& move, const Segment* segment, bool doubtful) {
  if (move.handling != Handling::own || move.group != 0 || any_axis(move.fixed)) return {};
  if (segment != nullptr) {
    const bool fades_inside = !segment->wanted.arc && move.may_split && !move.corners;
    return {Significance::may_stay, takes_all_words(move) && (fades_inside || !segment->cutting)};
  }
  if (move.cycle) return {Significance::may_stay, true};
  if (!all_known(move.known_end)) return {};
  if (all_known(move.known_start)) return {Significance::stands, true};
  return {doubtful ? Significance::corrected : Significance::may_stay, true};
}

class SignificanceOfMoves {
 public:
  void add_moves(const Job& job) {
    first_ = moves_.size();
    std::size_t next = 0;
    const std::vector<Segment>& segments = job.path.segments;
    for (std::size_t m = 0; m < job.program.moves.size(); ++m) {
      const bool has_segment = next < segments.size() && segments[next].move == m;
      moves_.push_back(
          before_samples(job.program.moves[m], has_segment ? &segments[next++] : nullptr, doubtful_));
      doubtful_ = leaves_doubt(job.program.moves[m], doubtful_);
    }
  }

  /// Of the moves added last.
  void add(const Job& job, const std::vector<Waypoint>& waypoints) {
    for (const Waypoint& w : waypoints) {
      MoveSignificance& move = moves_[first_ + w.move];
      if (move.is != Significance::may_stay && move.is != Significance::below) continue;
      const bool below = w.status == Status::converged && is_below_band(job, w, certain_share);
      move.is = below ? Significance::below : Significance::corrected;
      if (!below || !move.may_fade || !w.cutting) continue;
      const double rounding = rounding_allowance(job.program.moves[w.move], job.options.write);
      move.may_fade = is_below_band(job, w, fading_share - rounding / job.options.tolerance);
    }
  }

  std::vector<bool> ends_as_programmed() const {
    std::vector<bool> stay = ends_below_bands();
    const auto stands = [&](std::size_t m) { return moves_[m].is == Significance::stands; };
    bool before = false;
    for (std::size_t m = 0; m < moves_.size(); ++m) {
      if (!stands(m) && !before && !moves_[m].may_fade) stay[m] = false;
      if (stands(m)) stay[m] = before;
      before = stay[m];
    }
    bool end = true, may_fade = true;  // of the move behind
    for (std::size_t m = moves_.size(); m-- > 0;) {
      if (!end && !may_fade) stay[m] = false;
      end = stay[m];
      if (!stands(m)) may_fade = moves_[m].may_fade;
    }
    return stay;
  }

 private:
  std::vector<bool> ends_below_bands() const {
    std::vector<bool> stay(moves_.size());
    bool next_is_below = true;  // behind the last move nothing is to be corrected
    for (std::size_t m = moves_.size(); m-- > 0;) {
      if (moves_[m].is == Significance::stands) continue;
      const bool below = moves_[m].is == Significance::below;
      stay[m] = below && next_is_below;
      next_is_below = below;
    }
    return stay;
  }

  std::vector<MoveSignificance> moves_;
  std::size_t first_ = 0;  ///< of the window
  bool doubtful_ = false;  ///< `leaves_doubt` of the last move
};

}  // namespace

std::vector<bool> targets_as_programmed(JobWindows& windows, int threads, const WindowEvents& events) {
  SignificanceOfMoves moves;
  const WindowEvents all{events.read,
                         [&](const Job& job) {
                           moves.add_moves(job);
                           events.begun(job);
                         },
                         [&](const Job& job, const std::vector<Waypoint>& waypoints) {
                           moves.add(job, waypoints);
                           events.solved(job, waypoints);
                         },
                         events.done};
  const bool failed = predict_bands(windows, threads, all).has_value();
  std::vector<bool> stay = moves.ends_as_programmed();
  if (failed) stay.clear();
  return stay;
}

}  // namespace counterflex
