#pragma once
/// An independent judge of corrected text: it reads it, walks it, and solves every point cold.
#include "compensation/support/shop.hpp"

namespace counterflex::test {

/// One line or arc that the text commands on a wanted segment.
struct Commanded {
  std::size_t segment = 0;
  double u0 = 0, u1 = 1;
  Curve curve;  ///< targets in M (m)
};

/// A deviation of the tip, and where it is.
struct Miss {
  double size = 0;  ///< m
  int line = 0;
  double u = 0;
};

/// From home and from nothing: where the tip is for a target.
inline Vector3 cold_tip(const Shop& shop, const Model& model, const Vector3& target, const Vector6& F,
                        const Stage& stage = {}) {
  const NominalResult nominal = follow(model, model.home, {tip(model.mechanism, model.home).R, target});
  REQUIRE(nominal.status == Status::converged);
  StaticsWork work(model.mechanism);
  const Load load{F, shop.forces->at_platform()};
  const Equilibrium solved = solve_forward(model, nominal.configuration, load, stage, work);
  REQUIRE(solved.status == Status::converged);
  return tip(model.mechanism, solved.configuration).p;
}

inline Vector3 cold_tip(const Shop& shop, const Vector3& target, const Vector6& F, const Stage& stage = {}) {
  return cold_tip(shop, shop.model, target, F, stage);
}

/// What the moves of `text` command in M (m); of moves from unknown positions the end alone.
inline std::vector<Curve> ways_of(const Shop& shop, const std::string& text) {
  std::vector<Curve> ways;
  for (const Move& move : read_program(text, "corrected.ngc", {}).moves) {
    Curve way = curve_of(move);
    way.start *= mm;
    way.end *= mm;
    if (way.arc) way.arc->centre *= mm;
    ways.push_back(shop.X_MW * way);
  }
  return ways;
}

/// Positions in M (m) that the moves of `text` end at.
inline std::vector<Vector3> ends_of(const Shop& shop, const std::string& text) {
  std::vector<Vector3> ends;
  for (const Move& move : read_program(text, "corrected.ngc", {}).moves)
    ends.push_back(shop.X_MW * (move.end_mm * mm));
  return ends;
}

/// The feed pieces of a corrected text. Fractions are those that the waypoints claim; that the text ends a
/// move at every one of them is checked, that the tip is there the caller finds out.
inline std::vector<Commanded> commanded(const Shop& shop, const Compensation& result) {
  const std::vector<Curve> ways = ways_of(shop, result.text);
  std::vector<Commanded> pieces;
  std::size_t next = 0, segment = no_segment;
  double u0 = 0;
  for (const Waypoint& w : result.waypoints) {
    if (w.between) continue;
    const Vector3 target = w.p_MT - shop.datum_shift + w.correction.head<3>();
    while (next < ways.size() && (ways[next].end - target).norm() > 1e-12) ++next;
    CAPTURE(w.line);
    REQUIRE(next < ways.size());
    if (w.segment != segment) u0 = 0;
    segment = w.segment;
    if (w.cutting) pieces.push_back({w.segment, u0, w.fraction, ways[next]});
    u0 = w.fraction;
    ++next;
  }
  return pieces;
}

/// Every cutting segment is commanded from its start to its end.
inline void check_complete(const Shop& shop, const std::vector<Commanded>& pieces) {
  std::size_t at = 0;
  for (std::size_t s = 0; s < shop.path.segments.size(); ++s) {
    if (!shop.path.segments[s].cutting) continue;
    double u = 0;
    while (at < pieces.size() && pieces[at].segment == s) {
      CHECK(pieces[at].u0 == u);
      u = pieces[at++].u1;
    }
    CAPTURE(shop.path.segments[s].line);
    CHECK(u == 1);
  }
  CHECK(at == pieces.size());
}

/// The largest deviation from the wanted path at equal fractions, at both ends of every piece and at `inside`
/// places in it.
inline Miss dense_miss(const Shop& shop, const std::vector<Commanded>& pieces, int inside) {
  Miss worst;
  for (const Commanded& piece : pieces)
    for (int k = 0; k <= inside + 1; ++k) {
      const double v = k / (inside + 1.0), u = piece.u0 + v * (piece.u1 - piece.u0);
      const Segment& segment = shop.path.segments[piece.segment];
      const Vector3 wanted = point_at(segment.wanted, u);
      const Vector6 F = shop.forces->at(piece.segment, u, k == 0 ? Side::after : Side::before);
      const Vector3 reached = cold_tip(shop, model_of(shop.job(), segment), point_at(piece.curve, v), F);
      if ((reached - wanted).norm() > worst.size) worst = {(reached - wanted).norm(), segment.line, u};
    }
  return worst;
}

inline Miss dense_miss(const Shop& shop, const Compensation& result, int inside) {
  const std::vector<Commanded> pieces = commanded(shop, result);
  check_complete(shop, pieces);
  return dense_miss(shop, pieces, inside);
}

inline std::size_t pieces_on(const Compensation& result, int line) {
  std::size_t count = 0;
  for (const Waypoint& w : result.waypoints) count += w.line == line && w.cutting && !w.between;
  return count;
}

/// What `verify` finds of `text` as the corrected form of the shop's program.
inline Compensation judged(const Shop& shop, const std::string& text) {
  return verify(shop.job(), read_program(text, "corrected.ngc", {}), false);
}

/// The words with which `verify` refuses `text`; empty where it accepts it.
inline std::string refusal_of(const Shop& shop, const std::string& text) {
  try {
    const Compensation run = judged(shop, text);
    return run.failure ? run.failure->what : "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// The lines of `text`, without line ends.
inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  return lines;
}

}  // namespace counterflex::test
