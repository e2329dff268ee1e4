#pragma once
/// Plans neighbouring segments together: what all of them need is solved at once, then what some need more.
#include "force_response.hpp"
#include "interval_waves.hpp"
#include "plan_knots.hpp"

namespace counterflex {

/// Along a line without steps of the force the correction is taken to be
///
///     c(u) = (1 - u) c(0) + u c(1) + S dF(u)      dF(u) = F(u) - (1 - u) F(0) - u F(1)
///
/// S its response to the force, where that leaves most of the tolerance and the line is short. Of every eight
/// such lines in a row the longest one, and the one that S dF bends most, are solved inside: if they differ
/// from this the row is sampled as every other segment is, between its corners.
class ChunkPlanner {
 public:
  ChunkPlanner(const Job& job, WaypointSolver& solver);

  /// Segments [begin, end) of the solver's model. A failure need not be that of the first segment that fails,
  /// unless there is only one.
  std::optional<Failure> plan(std::size_t begin, std::size_t end, Plan& plan);

 private:
  enum class Kind { held, group, rapid, cut };

  struct Task {
    std::size_t segment = 0;
    Kind kind = Kind::held;
    Answer start = no_answer, end = no_answer, look = no_answer;
    Vector6 F_start = Vector6::Zero(), F_end = Vector6::Zero();  // of short lines; of cuts and rapids
    std::size_t first = 0, count = 0;  // of a group: in answers_; of a cut: in limits_
    bool as_line = false;              // of a cut: its inside need not be solved
    double length = 0, room = 0;       // of a line; what its knots may miss (m)
    std::optional<double> look_at{};   // a fraction
    std::size_t first_bend = 0, bends = 0;
    double bend = 0, bend_at = 0.5;  // the largest |S dF| (m), and where
  };
  struct Look {
    std::size_t row, task;
  };

  void clear(std::size_t segments);
  const Segment& segment(const Task& task) const { return job_.path.segments[task.segment]; }

  // What is asked first: ends, and all of arcs and groups.
  void add_task(std::size_t index);
  void ask_first(Task& task);
  void ask_group(Task& task, bool cutting);
  void add_limits(Task& task);
  void sample(Task& task);

  // Lines that need not be sampled.
  void choose_lines();
  Vector6 force_at_start(std::size_t t);
  void add_bends(Task& task);
  bool solve_responses();
  void ask_responses();
  void judge_bends();
  void look_into_lines();
  bool is_as_expected(const Look& look) const;
  void judge_rows();

  bool finish(const Task& task, PlannedSegment& planned);
  bool finish_sampled(const Task& task, PlannedSegment& planned);

  const Job& job_;
  TargetWaves waves_;
  IntervalWaves intervals_;
  KnotPlanner knots_;
  std::vector<Task> tasks_;
  std::vector<Answer> answers_;
  std::vector<double> limits_;    // fractions
  std::vector<ForceBend> bends_;  // at corners of the force, and in the middle, where it may be curved
  std::vector<ForceResponse> responses_;  // of spans of tasks
  std::vector<std::size_t> places_;       // of them: tasks
  std::vector<std::size_t> lines_;        // tasks; a row begins with every eighth
  std::vector<Look> looks_;
  std::vector<double> fractions_;
  std::size_t next_interval_ = 0;
};

}  // namespace counterflex
