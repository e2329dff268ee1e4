#include "compensation/plan/places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>

#include "compensation/solve/commands.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

constexpr int most_by_length = 64;  // a program of 100 kB may hold 20 000 moves across the whole machine

bool is_first_known(const Move& move) {
  return all_known(move.known_end) && !all_known(move.known_start) && !move.cycle;
}

BoxedOptional<Turn> turn_between(const Segment& segment, double u0, double u1) {
  if (!segment.turn) return {};
  return stretch(*segment.turn, u0, u1);
}

bool reverses_inside(const Job& job, const ForceChord& stretch) {
  if (job.directions == nullptr) return false;
  const auto is_inside = [&](double u) { return u > stretch.u0 && u < stretch.u1; };
  return std::ranges::any_of(job.directions->inside(job.path.segments[stretch.segment].move), is_inside);
}

// The pieces of a segment end at its places, or at its end alone.
std::vector<Piece> pieces_of(const Job& job, bool at_places) {
  std::vector<Piece> pieces;
  PlaceSolver solver(job);
  SegmentPlaces places{{1}};
  ForceCursor cursor;
  std::size_t next_move = 0;
  const auto add_ends_before = [&](std::size_t end) {
    for (; next_move < end; ++next_move) {
      const Move& move = job.program.moves[next_move];
      for (const double u : fractions_of_holes(move)) pieces.push_back(piece_of_hole(job, move, move, u));
      if (is_first_known(move)) pieces.push_back(piece_of_end(job, move, move));
    }
  };
  for (std::size_t s = 0; s < job.path.segments.size(); ++s) {
    const Segment& segment = job.path.segments[s];
    add_ends_before(segment.move);
    const Pose back{Matrix3::Identity(), -job.path.frames[segment.frame].datum_shift};
    if (at_places) places_along(job, solver, s, cursor, places);
    double u0 = 0;
    for (const double u : places.fractions) {
      pieces.push_back({.segment = s,
                        .move = segment.move,
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

// The fractions at which an actuator of the nominal machine passes a position of its table of errors. Between
// two steps it goes evenly, nearly.
void add_positions_of_tables(const Job& job, PlaceSolver& solver, const Segment& segment,
                             std::vector<double>& fractions) {
  const Model& model = model_of(job, segment);
  if (model.mechanism.error_knots.empty()) return;
  const int steps = steps_along(job, segment);
  std::vector<TipPosition> places;
  for (int k = 0; k <= steps; ++k) {
    const double u = static_cast<double>(k) / steps;
    places.push_back({&model, point_at(segment.wanted, u), orientation_at(segment, u)});
  }
  const std::vector<NominalResult> nominals = solver.nominals(places);
  for (std::size_t k = 1; k < nominals.size(); ++k) {
    if (nominals[k - 1].status != Status::converged || nominals[k].status != Status::converged) continue;
    const Eigen::VectorXd before = actuator_values(model.mechanism, nominals[k - 1].configuration);
    Eigen::VectorXd behind = actuator_values(model.mechanism, nominals[k].configuration);
    behind += full_turns(model.mechanism, behind, before);
    for (const ErrorKnots& knots : model.mechanism.error_knots) {
      const double from = before[knots.actuator], to = behind[knots.actuator];
      for (const double position : knots.rho)
        if (from != to && (position - from) * (position - to) <= 0)
          fractions.push_back((static_cast<double>(k - 1) + (position - from) / (to - from)) / steps);
    }
  }
}

// Whether the force inside a stretch is nowhere larger than at its ends by what reports show.
bool is_largest_at_ends(const Job& job, const ForceChord& stretch, std::span<const double> corners,
                        ForceCursor& cursor) {
  const auto size = [](const Vector6& F) { return Eigen::Array2d(F.head<3>().norm(), F.tail<3>().norm()); };
  const Eigen::Array2d most =
      size(stretch.F0).max(size(stretch.F1)) + Eigen::Array2d(shown_force, shown_moment);
  return std::ranges::all_of(corners, [&](double u) {
    return (size(job.forces.at(stretch.segment, u, Side::before, cursor)) <= most).all();
  });
}

// By how much the force differs from an even change between the ends of a stretch: at `corners` (fractions of
// the segment, inside the stretch) and, where it may curve between them, at its eighths.
void add_force_bends(const Job& job, const ForceChord& stretch, std::span<const double> corners,
                     ForceCursor& cursor, std::pmr::vector<Vector6>& bends) {
  const auto add = [&](double u) {
    const double v = (u - stretch.u0) / (stretch.u1 - stretch.u0);
    const Vector6 F = job.forces.at(stretch.segment, u, Side::before, cursor);
    bends.emplace_back(F - (1 - v) * stretch.F0 - v * stretch.F1);
  };
  const int inside = job.forces.is_linear_between_breaks() ? 0 : eighths - 1;
  bends.reserve(corners.size() + static_cast<std::size_t>(inside));
  for (const double u : corners) add(u);
  for (int k = 1; k <= inside; ++k)
    add(stretch.u0 + static_cast<double>(k) / eighths * (stretch.u1 - stretch.u0));
}

// How much the tip bends along a line that needs no places at the corners of the force; nothing where it
// needs them.
std::optional<double> bend_without_corners(const Job& job, PlaceSolver& solver, std::size_t index,
                                           std::span<const double> corners, ForceCursor& cursor) {
  const ForceChord whole{index, 0, 1, job.forces.at(index, 0, Side::after, cursor),
                         job.forces.at(index, 1, Side::before, cursor)};
  if (!is_largest_at_ends(job, whole, corners, cursor)) return std::nullopt;
  const LineBend bend = bend_of(job, solver, whole, corners, cursor);
  if (!(bend.gain * bend.command <= small_share * job.options.tolerance)) return std::nullopt;
  return bend.gain * bend.command;
}

// Adds places between those of an arc along which the force turns, so that the largest deviation is near one.
void add_turns_of_force(const Job& job, std::size_t index, ForceCursor& cursor,
                        std::vector<double>& fractions) {
  const std::size_t count = fractions.size();
  for (std::size_t k = 0; k <= count; ++k) {
    const double u0 = k == 0 ? 0 : fractions[k - 1], u1 = k == count ? 1 : fractions[k];
    const Vector6 F0 = job.forces.at(index, u0, Side::after, cursor),
                  F1 = job.forces.at(index, u1, Side::before, cursor),
                  F = job.forces.at(index, (u0 + u1) / 2, Side::before, cursor);
    // A chord of half the length is a quarter as far off. What turns with the arc needs no more places than
    // that: a force that grows is as large at one of its places.
    const double off = (F - (F0 + F1) / 2).norm(), turn = (u1 - u0) * angle_along(job.path.segments[index]),
                 by_force = std::sqrt(off / (turn_of_force * F.norm())),
                 by_angle = turn / (2 * std::acos(1 - turn_of_force));
    const double parts = off > 0 ? std::ceil(std::min(by_force, by_angle)) : 1;
    for (int i = 1; i < parts; ++i) fractions.push_back(u0 + (u1 - u0) * i / parts);
  }
  std::sort(fractions.begin(), fractions.end());
}

}  // namespace

double angle_along(const Segment& segment) {
  return std::max(segment.wanted.arc ? segment.wanted.arc->sweep : 0.0, turn_of(segment));
}

int steps_of_tables(const Job& job, const Segment& segment) {
  const Mechanism& mechanism = model_of(job, segment).mechanism;
  if (std::isinf(mechanism.error_spacing) && std::isinf(mechanism.error_spacing_angle)) return 1;
  const double way = length(segment.wanted), turned = way / mechanism.length + turn_of(segment);
  const double steps = std::ceil(way / mechanism.error_spacing + turned / mechanism.error_spacing_angle);
  return static_cast<int>(std::clamp(steps, 1.0, most_steps));
}

int steps_along(const Job& job, const Segment& segment) {
  if (!segment.cutting) return 1;
  const double by_length =
      std::clamp(std::ceil((segment.s_end - segment.s_start) / between_places), 1.0, double{most_by_length});
  const double by_angle = std::ceil(angle_along(segment) / angle_between_places);
  return std::max(static_cast<int>(std::max(by_length, by_angle)), steps_of_tables(job, segment));
}

void fractions_inside(const Job& job, PlaceSolver& solver, std::size_t index, int steps, ForceCursor& cursor,
                      std::vector<double>& fractions) {
  job.forces.breaks(index, cursor, fractions);
  add_positions_of_tables(job, solver, job.path.segments[index], fractions);
  if (job.directions != nullptr)
    for (const double u : job.directions->inside(job.path.segments[index].move)) fractions.push_back(u);
  for (int k = 1; k < steps; ++k) fractions.push_back(static_cast<double>(k) / steps);
  std::erase_if(fractions, [](double u) { return u < same_fraction || u > 1 - same_fraction; });
  std::sort(fractions.begin(), fractions.end());
  const auto same = [](double a, double b) { return b - a < same_fraction; };
  fractions.erase(std::unique(fractions.begin(), fractions.end(), same), fractions.end());
}

LineBend bend_of(const Job& job, PlaceSolver& solver, const ForceChord& stretch,
                 std::span<const double> corners, ForceCursor& cursor) {
  const Segment& segment = job.path.segments[stretch.segment];
  const bool steps = job.options.blend == 0 && !corners.empty();
  if (segment.wanted.arc || segment.turn || steps || reverses_inside(job, stretch))
    return {HUGE_VAL, HUGE_VAL};
  std::array<std::byte, 16 * sizeof(Vector6)> nearly_always_enough;
  std::pmr::monotonic_buffer_resource memory(nearly_always_enough.data(), nearly_always_enough.size());
  std::pmr::vector<Vector6> dF(&memory);
  add_force_bends(job, stretch, corners, cursor, dF);
  return solver.bend_along(model_of(job, segment),
                           {point_at(segment.wanted, stretch.u0), point_at(segment.wanted, stretch.u1),
                            stretch.F0, stretch.F1, dF});
}

void places_along(const Job& job, PlaceSolver& solver, std::size_t index, ForceCursor& cursor,
                  SegmentPlaces& places) {
  const Segment& segment = job.path.segments[index];
  std::vector<double>& fractions = places.fractions;
  fractions.clear();
  places.bend.reset();
  if (segment.cutting) {
    const int steps = steps_along(job, segment);
    fractions_inside(job, solver, index, steps, cursor, fractions);
    if (segment.wanted.arc) add_turns_of_force(job, index, cursor, fractions);
    if (steps == 1 && !fractions.empty())
      places.bend = bend_without_corners(job, solver, index, fractions, cursor);
    if (places.bend) fractions.clear();
  }
  fractions.push_back(1);
}

std::vector<Piece> original_pieces(const Job& job) {
  return pieces_of(job, true);
}

std::vector<Piece> original_moves(const Job& job) {
  return pieces_of(job, false);
}

}  // namespace counterflex
