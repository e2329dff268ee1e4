#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

// A point that an edit asks the text to come to.
struct Stop {
  Vector3 p_mm;
  double u;
  bool jump;
  bool end;
};

// Where the commands of a program stand, move by move.
class PieceReader {
 public:
  PieceReader(const Job& job, const Program& corrected) : job_(job), corrected_(corrected) {}

  // The next `count` moves command a segment's stops; rewriting gave no block to those that rounding
  // swallowed.
  void read(const EmittedMove& move, const MoveEdit& edit, std::size_t count, std::vector<Piece>& pieces) {
    const Segment& wanted = job_.path.segments[move.segment];
    take_stops(edit, move.fractions);
    std::size_t swallowed = stops_.size() - count;
    double u0 = 0;
    for (const Stop& stop : stops_) {
      const Vector3 from = swallowed > 0 || !tells_start() ? here() : Vector3(Vector3::Zero());
      const bool dropped = swallowed > 0 && is_held(stop, job_.program.moves[wanted.move]);
      if (dropped)
        --swallowed;
      else
        skip(1);
      if (stop.jump || (dropped && stop.u < 1)) continue;
      if (stop.u > u0 || !wanted.cutting) {
        Piece& piece = pieces.emplace_back();
        piece.segment = move.segment;
        piece.line = wanted.line;
        piece.u0 = u0;
        piece.u1 = stop.u;
        piece.frame = wanted.frame;
        piece.commanded = dropped ? Curve{from, from, {}} : command(from);
        piece.end_only = !wanted.cutting;
        piece.exempt = move.exempt;
        piece.exempt_end = move.exempt_end;
      }
      u0 = stop.u;
    }
  }

  // The bottom of a hole.
  void read_hole(const EmittedMove& move, std::size_t count, std::vector<Piece>& pieces) {
    const Move& original = job_.program.moves[move.edit.move];
    skip(count);
    const WorkFrame& frame = job_.path.frames[original.offset];
    const Vector3 bottom = frame.X_MW * (bottom_of(corrected_.moves[next_ - 1]) * mm);
    pieces.push_back({.segment = no_segment,
                      .line = original.line,
                      .frame = original.offset,
                      .commanded = {bottom, bottom, {}},
                      .wanted = wanted_frame(frame) * (bottom_of(original) * mm),
                      .end_only = true,
                      .exempt_end = move.exempt_end,
                      .tool = original.tool});
  }

  // A single position: the next `count` moves end at it.
  void read_position(const EmittedMove& move, std::size_t count, std::vector<Piece>& pieces) {
    const Move& original = job_.program.moves[move.edit.move];
    skip(count);
    pieces.push_back({.segment = no_segment,
                      .line = original.line,
                      .frame = original.offset,
                      .commanded = {here(), here(), {}},
                      .wanted = wanted_of(job_, original),
                      .end_only = true,
                      .exempt_end = move.exempt_end,
                      .tool = original.tool});
  }

  void skip(std::size_t count) { next_ += count; }

 private:
  void take_stops(const MoveEdit& edit, const std::vector<double>& fractions) {
    stops_.clear();
    if (edit.jump_mm) stops_.push_back({*edit.jump_mm, 0, true, false});
    for (std::size_t k = 0; k < edit.inserted.size(); ++k)
      stops_.push_back({edit.inserted[k].end_mm, fractions[k], false, false});
    stops_.push_back({edit.end_mm, 1, false, true});
  }

  // Whether the text holds the stop already, and the next move does not say it again.
  bool is_held(const Stop& stop, const Move& original) const {
    const Move* last = move_before(corrected_, next_);
    if (last == nullptr) return false;
    const Vector3& held_mm = last->end_mm;
    if (next_ < corrected_.moves.size() && corrected_.moves[next_].end_mm == held_mm) return false;
    const Decimals decimals = decimals_of(original, job_.options.write);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const int digits = stop.end ? decimals.end[static_cast<std::size_t>(axis)] : decimals.inserted;
      const double digit = std::pow(10.0, -digits) * (original.unit == LengthUnit::inches ? inch / mm : 1);
      if (std::abs(stop.p_mm[axis] - held_mm[axis]) > 0.5 * digit * (1 + 1e-9)) return false;
    }
    return true;
  }

  // Whether the text tells where the next move starts.
  bool tells_start() const {
    return next_ < corrected_.moves.size() && all_known(corrected_.moves[next_].known_start);
  }

  // The way of the last move; where the text does not tell its start, from where it held the tool.
  Curve command(const Vector3& from) const {
    const Move& move = corrected_.moves[next_ - 1];
    return all_known(move.known_start) ? command_of(job_, move) : Curve{from, here(), {}};
  }

  Vector3 here() const {
    const Move* last = move_before(corrected_, next_);
    return last == nullptr ? Vector3(Vector3::Zero()) : target_of(job_, *last);
  }

  const Job& job_;
  const Program& corrected_;
  std::size_t next_ = 0;
  std::vector<Stop> stops_;  // of one move; the room is used again
};

}  // namespace

std::vector<Piece> emitted_pieces(const Job& job, const Emission& emission,
                                  const std::vector<MoveEdit>& edits, const Rewritten& rewritten,
                                  const Program& corrected) {
  std::vector<Piece> pieces;
  pieces.reserve(corrected.moves.size());
  PieceReader reader(job, corrected);
  std::size_t next = 0;
  for (std::size_t e = 0; e < emission.moves.size(); ++e) {
    const EmittedMove& move = emission.moves[e];
    reader.skip(move.edit.move - next);
    const std::size_t count = rewritten.blocks_of_edit[e] + 1;
    if (move.kind == EmittedMove::Kind::first_known)
      reader.read_position(move, count, pieces);
    else if (move.kind == EmittedMove::Kind::hole)
      reader.read_hole(move, count, pieces);
    else if (move.kind == EmittedMove::Kind::shifted)
      reader.skip(count);
    else
      reader.read(move, edits[e], count, pieces);
    next = move.edit.move + 1;
  }
  return pieces;
}

}  // namespace counterflex
