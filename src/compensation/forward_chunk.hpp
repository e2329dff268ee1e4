#pragma once
/// Solves neighbouring pieces forward together: first the samples of all of them, then closer ones where they
/// are needed.
#include <span>

#include "counterflex/compensation/waypoint.hpp"
#include "forward_sources.hpp"

namespace counterflex {

/// The waypoints of pieces that need the same model. `solve_forward_along` describes the samples.
class ChunkForward {
 public:
  ChunkForward(const Job& job, const Questions& questions, WaypointSolver& solver);

  /// Solves `pieces`, all of the solver's model; `command` is where the piece before them ended. Appends
  /// their waypoints. Where one fails the last waypoint is the first of those that do; it need not be the
  /// first of all unless there is only one piece.
  std::optional<Failure> solve(std::span<const Piece> pieces, const std::optional<Vector3>& command,
                               std::vector<Waypoint>& out);

 private:
  struct Task {
    const Piece* piece = nullptr;
    const Segment* segment = nullptr;  // none: a position
    bool begins_anew = false;
    bool begins_run = false;  // its start is a place of the original path
  };
  // A place on a piece: fraction `v` of the piece, `u` of the segment.
  struct Sample {
    std::size_t task = 0;
    double v = 1, u = 1;
    bool between = false;
    bool place = false;  // of the original path
    bool listed = true;
    Side side = Side::before;  // of a step of the force
  };
  // Between two neighbouring places of a piece: samples at its ends and in its middle.
  struct Stretch {
    std::size_t task;
    double v0, v1;
    std::size_t a, m, b;
  };

  void clear();
  void reserve(std::size_t pieces);
  std::size_t add(const Sample& sample);
  std::size_t add_inside(std::size_t t, double v);
  bool solve_added();
  Failure failure_at(std::size_t k, const Waypoint& w) const;  ///< of the listed sample k

  void begin(std::span<const Piece> pieces, const std::optional<Vector3>& command);
  void add_samples(std::size_t t);
  std::size_t add_start(std::size_t t);
  std::size_t add_behind_step(std::size_t before);
  void read_places(const Piece& piece);
  bool is_place(double u) const;
  bool is_where_the_last_ended(const Task& task);
  void sample_closer();
  bool is_safe(const Stretch& stretch) const;

  Vector3 wanted_at(const Task& task, double u) const;
  Vector3 miss(std::size_t sample) const;
  void order_samples();
  // Every sample stands for half of the way to those beside it, the end for half of the way behind the start,
  // too.
  void write_waypoints(std::vector<Waypoint>& out);
  void write_waypoint(std::size_t s, double share, std::vector<Waypoint>& out);
  Status status(std::size_t sample) const;

  const Job& job_;
  const Questions& questions_;
  WaypointSolver& solver_;
  Vector3 judged_ = Vector3::Zero();  // 1 for axes of M in which the tip is judged, else 0
  ForceCursor cursor_;
  std::vector<Task> tasks_;
  std::vector<double> places_along_;  // fractions of the segment `places_of_`
  std::size_t places_of_ = no_segment;
  std::vector<Stretch> stretches_;

  // By sample.
  std::vector<Sample> samples_;
  std::vector<Vector3> p_MT_;
  std::vector<ActualRequest> requests_;
  std::vector<WantedPose> wanted_;
  std::vector<ActualSolution> actuals_;

  std::vector<std::size_t> begins_, filled_, order_;
  std::vector<ForwardPlace> places_;
};

}  // namespace counterflex
