#pragma once
/// Samples of pieces, solved forward: their ends, and as many inside as the tolerance needs.
#include <optional>
#include <span>

#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

struct SampledPiece {
  const Piece* piece = nullptr;
  const Segment* segment = nullptr;  ///< none: a position
  const Model* model = nullptr;
  bool begins_elsewhere = false;  ///< the piece before it ended elsewhere
  bool starts_at_place = false;   ///< its start is a place of the original path
};

/// A place on a piece: fraction `v` of the piece, `u` of the segment.
struct PieceSample {
  std::size_t piece = 0;  ///< index into PieceSamples::pieces
  double v = 1, u = 1;
  bool between = false;      ///< inside the piece
  bool place = false;        ///< of the original path
  bool listed = true;        ///< becomes a waypoint
  Side side = Side::before;  ///< of a step of the force
  /// Of what the control puts between the piece and the next one, at a sample on it. The miss along it is not
  /// one: the way may begin earlier or later.
  std::optional<Vector3> corner_direction{};
};

/// All but `pieces` and `order` are by sample.
struct PieceSamples {
  std::vector<SampledPiece> pieces{};
  std::vector<PieceSample> samples{};
  std::vector<TipPosition> places{};
  std::vector<ForwardRequest> requests{};
  std::vector<WantedPose> wanted{};
  std::vector<ForwardAnswer> answers{};
  std::vector<std::size_t> order{};  ///< listed samples in order along the path, to the first that fails

  const SampledPiece& piece_of(std::size_t s) const { return pieces[samples[s].piece]; }
  Status status(std::size_t s) const {
    return wanted[s].status != Status::converged ? wanted[s].status : answers[s].status;
  }
};

/// Solves `pieces` as `solve_pieces` describes; `command`: where the piece before them ended; `next`: the
/// piece behind them, if any.
PieceSamples sample_pieces(const Job& job, PlaceSolver& solver, std::span<const Piece> pieces,
                           const Questions& questions, const std::optional<Vector3>& command,
                           const Piece* next);

}  // namespace counterflex
