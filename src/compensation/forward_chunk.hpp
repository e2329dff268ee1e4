#pragma once
/// Solves neighbouring pieces forward together: what all of them need is solved at once, then what some need
/// more.
#include <span>

#include "counterflex/compensation/waypoint.hpp"
#include "force_response.hpp"
#include "forward_sources.hpp"

namespace counterflex {

/// The waypoints of pieces that need the same model; what is sampled `solve_forward_along` says.
class ChunkForward {
 public:
  /// `known`: what is known already, by segment; it may be empty.
  ChunkForward(const Job& job, const Questions& questions, std::span<const KnownSegment> known,
               WaypointSolver& solver);

  /// Solves `pieces`, all of the solver's model; `command` is where the piece before them ended. Appends
  /// their waypoints. Where one fails the last waypoint is the first of those that do; it need not be the
  /// first of all unless there is only one piece.
  std::optional<Failure> solve(std::span<const Piece> pieces, const std::optional<Vector3>& command,
                               std::vector<Waypoint>& out);

 private:
  struct Task {
    const Piece* piece = nullptr;
    const Segment* segment = nullptr;  // none: a position
    std::size_t start = no_answer, end = no_answer;
    bool begins_anew = false;
    bool line = false;      // is judged inside, as a line
    bool foreseen = false;  // and so not sampled inside, unless for its row
    std::size_t look = no_answer;
    double room = 0;    // the tolerance (m)
    double length = 0;  // of a line (m)
    // In bends_; behind the corners of the force the middle, where it may be curved.
    std::size_t first = 0, corners = 0, bends = 0;
    double bend = 0, bend_at = 0.5;  // the largest |S dF| (m), and where
  };
  struct Sample {
    std::size_t task = 0;
    double v = 1, u = 1;
    bool between = false, listed = true;
    bool may_fail = false;  // a probe
  };
  // Between two neighbouring corners: samples at its ends and in its middle.
  struct Stretch {
    std::size_t task;
    double v0, v1;
    std::size_t a, m, b;
  };
  struct Look {
    std::size_t row, sample;
  };

  void clear();
  void reserve(std::size_t pieces);
  std::size_t add(std::size_t task, double v, bool between, bool listed = true);
  std::size_t add_probe(std::size_t sample, const Vector6& dF);
  bool solve_added();
  const KnownPlace* known_place(const Sample& sample) const;
  bool run_waves();

  void begin(std::span<const Piece> pieces, const std::optional<Vector3>& command);
  void add_first(std::size_t t);
  bool is_where_the_last_ended(const Task& task);
  int arc_samples(const Task& task) const;
  void add_bends(Task& task);

  void choose_short_lines();
  void ask_responses();
  void judge_bends();
  void look_into_lines();
  bool went_as_foreseen(const Look& look) const;
  void judge_rows();
  void sample(std::size_t t);
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
  const std::span<const KnownSegment> segments_;
  WaypointSolver& solver_;
  Vector3 judged_ = Vector3::Zero();  // 1 for axes of M in which the tip is judged, else 0
  ForceCursor cursor_;
  std::vector<Task> tasks_;
  std::vector<double> fractions_;
  std::vector<ForceBend> bends_;
  std::vector<ForceResponse> responses_;  // of spans of tasks
  std::vector<std::size_t> lines_;        // short ones; a row begins with every eighth
  std::vector<Look> looks_;
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
