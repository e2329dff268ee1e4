// Which moves of a corrected program belong to which of the original: inserted blocks come before the block
// that they split and follow its path. The first piece has the number of the block.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "commands.hpp"
#include "counterflex/compensation/compensate.hpp"
#include "counterflex/geometry/units.hpp"
#include "emit.hpp"
#include "match_pieces.hpp"
#include "same_program.hpp"
#include "skeleton.hpp"

namespace counterflex {
namespace {

constexpr double length_share = 0.1;  // a difference of lengths counts for less than one of places
constexpr double nearer_mm = 1e-9;

bool makes_doubtful(const Move& move) {
  bool lost = move.block_delete;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lost = lost || move.fixed[axis] || (move.known_start[axis] && !move.known_end[axis]);
  return lost;
}

class Matcher {
 public:
  Matcher(const Job& job, const Program& corrected) : job_(job), corrected_(corrected), expected_(job) {}

  // Stretch by stretch between lines that hold no move: what was inserted for a move lies in its own.
  std::vector<Piece> run() {
    const auto stretch = other_lines_before(job_.program), found = other_lines_before(corrected_);
    const auto& originals = job_.program.moves;
    for (std::size_t m = 0; m < originals.size();) {
      const std::size_t end = std::upper_bound(stretch.begin(), stretch.end(), stretch[m]) - stretch.begin();
      const std::size_t found_end = std::upper_bound(found.begin(), found.end(), stretch[m]) - found.begin();
      if (found_end < next_ + (end - m)) fail(originals[m], "the corrected program has fewer moves here");
      for (; m < end; ++m) {
        const std::size_t surplus = found_end - next_ - (end - m);
        const std::size_t own = m + 1 == end ? next_ + surplus : find(m, next_ + surplus);
        take(m, own);
        next_ = own + 1;
      }
    }
    return std::move(pieces_);
  }

 private:
  [[noreturn]] void fail(const Move& move, const std::string& what) const {
    throw InputError(Exit::not_compensated, {job_.program.file, move.line, 1}, what + " (verify)");
  }

  // Index of the corrected move, at most `last`, that ends original move m: its blocks say the same words, it
  // ends nearest to where it should, and the way to it is about as long.
  std::size_t find(std::size_t m, std::size_t last) {
    const Move& original = job_.program.moves[m];
    const std::string words = skeleton(job_.program, original);
    const Vector3 end_mm = next_ == last ? original.end_mm : expected_end_mm(m);
    const double length_mm = length(curve_of(original)), slack_mm = 2 * job_.options.max_correction / mm;
    std::optional<std::size_t> best;
    double best_miss = std::numeric_limits<double>::infinity(), gone_mm = 0;
    for (std::size_t j = next_; j <= last; ++j) {
      const Move& move = corrected_.moves[j];
      if (j > next_ && begins_next(m, move)) break;
      gone_mm += length(curve_of(move));
      const double miss = (move.end_mm - end_mm).norm() + length_share * std::abs(gone_mm - length_mm);
      if (may_end(original, words, j) && miss < best_miss - nearer_mm) best = j, best_miss = miss;
      if (!may_go_on(original, words, j) || gone_mm > length_mm + slack_mm) break;
    }
    if (!best)
      fail(original,
           "no move of the corrected program continues this one with the same words (motion, F, S, M)");
    return *best;
  }

  // Whether a corrected move has the number of the original move behind `m`.
  bool begins_next(std::size_t m, const Move& move) const {
    const auto& originals = job_.program.moves;
    return move.block_number && m + 1 < originals.size() && originals[m + 1].block_number == move.block_number;
  }

  // A feed block whose words act at its beginning is itself the first piece: the others follow it.
  bool acts_first(const Move& original, const std::string& words) const {
    return original.motion == Motion::feed && !is_plain(words);
  }

  bool may_end(const Move& original, const std::string& words, std::size_t j) const {
    const Move& move = corrected_.moves[j];
    const std::string found = skeleton(corrected_, move);
    if (move.motion != original.motion) return false;
    if (j > next_ && acts_first(original, words)) return is_plain(found);
    return found == words;
  }

  // Whether another piece of the same move may follow corrected move j.
  bool may_go_on(const Move& original, const std::string& words, std::size_t j) const {
    const Move& move = corrected_.moves[j];
    const std::string found = skeleton(corrected_, move);
    if (move.motion != Motion::feed) return false;
    if (j == next_ && acts_first(original, words)) return found == words;
    return is_plain(found);
  }

  // Where the move should end (mm): with its own correction, or with the one with which it is entered.
  Vector3 expected_end_mm(std::size_t m) {
    const Move& original = job_.program.moves[m];
    const bool solves = is_own(original) && !original.cycle && segment_ < job_.path.segments.size() &&
                        job_.path.segments[segment_].move == m;
    const auto target = solves ? expected_.at(segment_, 1, Side::before) : std::nullopt;
    if (!target) return original.end_mm + correction_mm_;
    return in_words_mm(job_, original, *target);
  }

  // A restart at the number of a block runs the whole move.
  void check_numbers(const Move& original, std::size_t own) const {
    for (std::size_t j = next_; j <= own; ++j) {
      const Move& move = corrected_.moves[j];
      const bool right = j == next_ ? move.block_number == original.block_number
                                    : !move.block_number || original.block_number;
      if (!right)
        throw InputError(Exit::not_compensated, {corrected_.file, move.line, 1},
                         "the N of a block belongs to its first piece, and other pieces of a block without N "
                         "have none");
    }
  }

  // Inserted blocks say motion, axes and F, and the F is the one that acts.
  void check_inserted(const Move& original, std::size_t own) const {
    const std::string wanted = skeleton(job_.program, original);
    std::size_t own_blocks = 0;
    check_numbers(original, own);
    for (std::size_t j = next_; j <= own; ++j) {
      const Move& move = corrected_.moves[j];
      const std::string found = skeleton(corrected_, move);
      if (found == wanted) ++own_blocks;
      const bool plain = is_plain(found) && found.find_first_of("(;") == std::string::npos;
      const bool same_motion = move.motion == original.motion || (j < own && move.motion == Motion::feed);
      const bool same_feed = move.motion == Motion::rapid || move.feed_mode == FeedMode::inverse_time ||
                             move.feed_mm_min == original.feed_mm_min;
      if ((found != wanted && !plain) || !same_motion || !same_feed)
        throw InputError(Exit::not_compensated, {corrected_.file, move.line, 1},
                         "an inserted block may state motion, axes and the feed that acts, nothing else");
    }
    if (own_blocks == 0 || (own_blocks > 1 && !is_plain(wanted)))
      fail(original, "its words stand in no block, or in several, of the corrected program");
  }

  void take(std::size_t m, std::size_t own) {
    const Move& original = job_.program.moves[m];
    check_inserted(original, own);
    const bool has_segment = segment_ < job_.path.segments.size() && job_.path.segments[segment_].move == m;
    if (has_segment && original.cycle)
      ++segment_;
    else if (has_segment)
      add_pieces(job_, corrected_, {segment_++, next_, own}, expected_, pieces_);
    if (original.cycle && original.known_end[0] && original.known_end[1]) take_hole(original, own);
    const bool known = all_known(original.known_end);
    if (known) correction_mm_ = corrected_.moves[own].end_mm - original.end_mm;
    if (known && !has_segment && !all_known(original.known_start) && !original.cycle)
      pieces_.push_back({.segment = no_segment,
                         .line = original.line,
                         .frame = original.offset,
                         .commanded = {position(own), position(own), {}},
                         .wanted = wanted_of(job_, original),
                         .end_only = true,
                         .exempt_end = !is_own(original) || !original.may_insert_words ||
                                       (skipped_ && original.motion == Motion::feed),
                         .tool = original.tool});
    skipped_ = makes_doubtful(original) || (skipped_ && !known);
  }

  static bool is_own(const Move& move) { return move.handling == Handling::own; }

  void take_hole(const Move& original, std::size_t own) {
    const Move& found = corrected_.moves[own];
    if (!found.cycle) fail(original, "this cycle is none in the corrected program");
    const WorkFrame& frame = job_.path.frames[original.offset];
    const Vector3 bottom = frame.X_MW * (bottom_of(found) * mm);
    const bool takes_z = original.cycle->bottom_word || original.cycle->may_insert_bottom;
    pieces_.push_back({.segment = no_segment,
                       .line = original.line,
                       .frame = original.offset,
                       .commanded = {bottom, bottom, {}},
                       .wanted = wanted_frame(frame) * (bottom_of(original) * mm),
                       .end_only = true,
                       .exempt_end = !is_own(original) || !takes_z,
                       .tool = original.tool});
  }

  Vector3 position(std::size_t j) const { return target_of(job_, corrected_.moves[j]); }

  const Job& job_;
  const Program& corrected_;
  ExpectedTargets expected_;
  std::vector<Piece> pieces_;
  std::size_t next_ = 0, segment_ = 0;
  Vector3 correction_mm_ = Vector3::Zero();
  bool skipped_ = false;  // a '/' block made the position unknown: feed moves behind it are held, not judged
};

}  // namespace

std::vector<Piece> match_programs(const Job& job, const Program& corrected) {
  check_other_lines(job.program, corrected);
  std::vector<Piece> pieces = Matcher(job, corrected).run();
  refine_fractions(job, pieces);
  drop_jumps(job, pieces);
  check_all_moves(job, corrected, pieces);
  return pieces;
}

}  // namespace counterflex
