// The original program as pieces of its own path.
#include "compensation/plan/places.hpp"
#include "compensation/solve/commands.hpp"

namespace counterflex {
namespace {

bool is_known_hole(const Move& move) {
  const auto& fixed = move.fixed;
  return move.cycle && move.handling == Handling::own && !fixed[0] && !fixed[1] && !fixed[2];
}

bool is_first_known(const Move& move) {
  return all_known(move.known_end) && !all_known(move.known_start) && !move.cycle;
}

}  // namespace

namespace {

BoxedOptional<Turn> turn_between(const Segment& segment, double u0, double u1) {
  if (!segment.turn) return {};
  return stretch(*segment.turn, u0, u1);
}

// `places_of` sets the fractions at which the pieces of a segment end.
template <typename PlacesOf>
std::vector<Piece> pieces_of(const Job& job, const PlacesOf& places_of) {
  std::vector<Piece> pieces;
  std::vector<double> places;
  std::size_t next_move = 0;
  const auto add_ends_before = [&](std::size_t end) {
    for (; next_move < end; ++next_move) {
      const Move& move = job.program.moves[next_move];
      if (is_known_hole(move)) pieces.push_back(piece_of_hole(job, move, move));
      if (is_first_known(move)) pieces.push_back(piece_of_position(job, move, move));
    }
  };
  for (std::size_t s = 0; s < job.path.segments.size(); ++s) {
    const Segment& segment = job.path.segments[s];
    add_ends_before(segment.move);
    const Pose back{Matrix3::Identity(), -job.path.frames[segment.frame].datum_shift};
    places_of(s, places);
    double u0 = 0;
    for (const double u : places) {
      pieces.push_back({.segment = s,
                        .line = segment.line,
                        .u0 = u0,
                        .u1 = u,
                        .frame = segment.frame,
                        .commanded = back * stretch(segment.wanted, u0, u),
                        .turn = turn_between(segment, u0, u),
                        .end_only = !segment.cutting});
      u0 = u;
    }
  }
  add_ends_before(job.program.moves.size());
  return pieces;
}

}  // namespace

std::vector<Piece> original_pieces(const Job& job) {
  ForceCursor cursor;
  return pieces_of(job,
                   [&](std::size_t s, std::vector<double>& places) { places_along(job, s, cursor, places); });
}

std::vector<Piece> original_moves(const Job& job) {
  return pieces_of(job, [](std::size_t, std::vector<double>& places) { places = {1}; });
}

}  // namespace counterflex
