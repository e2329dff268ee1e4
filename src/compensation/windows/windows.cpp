#include "counterflex/compensation/windows.hpp"

#include <algorithm>

#include "compensation/solve/failures.hpp"
#include "compensation/solve/path_directions.hpp"
#include "compensation/solve/tool_orientations.hpp"
#include "compensation/windows/turns.hpp"
#include "compensation/windows/window_steps.hpp"

namespace counterflex {

namespace {

// Sets the wanted turns about the spindle axis. `first`: number of the window's first move.
void set_spins(const std::vector<double>& spins, std::size_t first, Program& window) {
  for (std::size_t m = 0; m < window.moves.size(); ++m) {
    Move& move = window.moves[m];
    if (!move.orientation) continue;
    MoveOrientation& orientation = *move.orientation;
    const std::size_t number = first + m;
    orientation.end_spin = spins[number];
    if (!all_known(move.known_start))
      orientation.start_spin = orientation.end_spin;
    else
      orientation.start_spin = move.starts_uncorrected || number == 0 ? 0 : spins[number - 1];
  }
}

void reset_spins(Program& window) {
  for (Move& move : window.moves)
    if (move.orientation) move.orientation->start_spin = move.orientation->end_spin = 0;
}

}  // namespace

// The forces are those of the program as it is: they do not turn with the flange.
void JobWindows::build(JobWindow& window) const {
  Program& program = reader_.window();
  ignore_axes(program, input_.ignored);
  if (input_.spins != nullptr) reset_spins(program);
  window.path = build_toolpath(program, input_.frames, path_end_);
  const std::vector<Matrix3> R_MT = tool_orientations(input_, program, window.path);
  const std::vector<Matrix3> at_holes =
      R_MT.size() > 1 ? tool_orientations_at_holes(input_, program) : std::vector<Matrix3>{};
  if (input_.spins != nullptr) {
    set_spins(*input_.spins, moves_, program);
    window.path = build_toolpath(program, input_.frames, path_end_);
  }
  window.forces.emplace(input_.source, program, window.path, R_MT, forces_, at_holes);
}

bool JobWindows::next(JobWindow& window) {
  if (!reader_.next()) return false;
  build(window);
  while (!window.forces->is_final() && reader_.extend()) build(window);
  reader_.take_window(window.program);
  window.from = tip_;
  window.first_move = moves_;
  moves_ += window.program.moves.size();
  path_end_ = window.path.end;
  forces_ = window.forces->tail();
  window.directions = PathDirections{};
  window.directions = directions_along(job(window), directions_);
  if (window.path.segments.empty()) return true;
  const Segment& last = window.path.segments.back();
  tip_ = TipPosition{&model_of(job(window), last), last.wanted.end, orientation_at(last, 1)};
  return true;
}

Job JobWindows::job(const JobWindow& window) const {
  return {.model = input_.model,
          .program = window.program,
          .path = window.path,
          .forces = *window.forces,
          .options = input_.options,
          .read = input_.read,
          .tools = input_.tools,
          .starts = input_.starts,
          .from = window.from,
          .directions = has_reversals(input_.model) ? &window.directions : nullptr,
          .uncertainties = input_.uncertainties,
          .as_programmed = input_.as_programmed,
          .first_move = window.first_move};
}

Directions first_directions(const RunInput& input, ProgramReader& reader) {
  Directions first = input.first_directions;
  DirectionsEnd end{first, {}};
  PathEnd path_end;
  std::size_t moves = 0;  // before the window
  const std::vector<double>& reversal = input.model.mechanism.reversal;
  const auto is_known = [&] {
    for (std::size_t a = 0; a < reversal.size(); ++a)
      if (reversal[a] > 0 && first.of(a) == 0) return false;
    return true;
  };
  const ForceSource no_forces;
  while (!is_known() && reader.next()) {
    ignore_axes(reader.window(), input.ignored);
    if (input.spins != nullptr) set_spins(*input.spins, moves, reader.window());
    moves += reader.window().moves.size();
    const Toolpath path = build_toolpath(reader.window(), input.frames, path_end);
    const PathForces forces(no_forces, reader.window(), path, {Matrix3::Identity()});
    add_first_motions(directions_along({.model = input.model,
                                        .program = reader.window(),
                                        .path = path,
                                        .forces = forces,
                                        .options = input.options,
                                        .read = input.read,
                                        .tools = input.tools,
                                        .starts = input.starts},
                                       end),
                      first);
    path_end = path.end;
  }
  return first;
}

namespace {

// As many windows at once as there are threads: the steps in order are the smaller part. Each window takes
// some megabytes, so there are never more than this.
constexpr std::size_t most_windows = 6;

// Places of a window whose waypoints are solved and given out in portions, when all windows before it are
// done.
constexpr std::size_t large_window = 16 * window_moves;

// A window, the error that waits until all windows before it are done, and whether one before it has failed.
struct WindowInProgress {
  JobWindow input{};
  WindowWork work{};
  bool is_read = false, given_up = false;
  std::exception_ptr error{};

  bool may_continue() const { return !given_up && !error && !work.failed(); }
};

class WindowRun {
 public:
  WindowRun(JobWindows& windows, int threads, const WindowSteps& steps, const WindowEvents& events)
      : windows_(windows), threads_(threads), steps_(steps), events_(events), turns_(threads, in_order) {}

  std::optional<Failure> run() {
    turns_.run(std::clamp<std::size_t>(static_cast<std::size_t>(threads_), 1, most_windows),
               [this] { work(); });
    return failure_;
  }

 private:
  enum { reading, writing, delivery, in_order };  // the steps in order

  // One window after another.
  void work() {
    WindowInProgress window;
    for (;;) {
      const std::size_t item = turns_.take();
      bool found = false;
      if (!turns_.in_turn(reading, item, [&] { found = read(window); }) || !found) return;
      step(window, turns_.free_threads(), steps_.prepare);
      const auto write = [&] {
        window.given_up = has_failed_;
        step(window, 1, steps_.write);
        has_failed_ = !window.may_continue();
      };
      if (!turns_.in_turn(writing, item, write)) return;
      const int threads = turns_.free_threads();
      step(window, threads, steps_.match);
      if (!is_large(window)) step(window, threads, [this](const Job& job, WindowWork& w) { solve(job, w); });
      if (!turns_.in_turn(delivery, item, [&] { deliver(window); })) return;
    }
  }

  bool read(WindowInProgress& window) {
    if (all_read_) return false;
    window.work = {};
    window.is_read = window.given_up = false;
    window.error = nullptr;
    try {
      all_read_ = !windows_.next(window.input);
      if (all_read_) return false;
      window.is_read = true;
      events_.read(windows_.job(window.input));
    } catch (...) {
      window.error = std::current_exception();
      all_read_ = true;
    }
    return true;
  }

  void step(WindowInProgress& window, int threads, const WindowSteps::Step& take) {
    if (!window.may_continue()) return;
    try {
      Job job = windows_.job(window.input);
      job.options.threads = threads;
      take(job, window.work);
    } catch (...) {
      window.error = std::current_exception();
    }
  }

  static bool is_large(const WindowInProgress& window) {
    return window_size(window.input.program) > large_window;
  }

  void solve(const Job& job, WindowWork& work) const {
    ForwardRun run = solve_pieces(job, work.pieces, steps_.questions, work.command);
    work.pieces = {};
    work.result.waypoints = std::move(run.waypoints);
    work.result.failure = std::move(run.failure);
  }

  void deliver(WindowInProgress& window) {
    if (window.is_read) events_.begun(windows_.job(window.input));
    if (window.error) std::rethrow_exception(window.error);
    Job job = windows_.job(window.input);
    job.options.threads = threads_;
    WindowWork& work = window.work;
    std::optional<Failure> missed;
    const auto take = [&](const std::vector<Waypoint>& some) {
      if (!missed) missed = tolerance_failure(job, some);
      events_.solved(job, some);
    };
    if (is_large(window) && !work.failed())
      work.result.failure = solve_in_portions(job, work.pieces, steps_.questions, work.command, take);
    else
      take(work.result.waypoints);
    steps_.judge(job, work, missed);
    events_.done(job, work.result);
    failure_ = work.result.failure;
    if (failure_) turns_.stop();
  }

  JobWindows& windows_;
  const int threads_;
  const WindowSteps& steps_;
  const WindowEvents& events_;
  Turns turns_;
  bool all_read_ = false;    // of the step `reading`
  bool has_failed_ = false;  // of the step `writing`: no window behind it can be written
  std::optional<Failure> failure_;
};

}  // namespace

std::optional<Failure> predict_windows(JobWindows& windows, int threads, const WindowEvents& events) {
  PathCarry carry;
  return WindowRun(windows, threads, steps_of_prediction(carry), events).run();
}

std::optional<Failure> predict_bands(JobWindows& windows, int threads, const WindowEvents& events) {
  PathCarry carry;
  return WindowRun(windows, threads, steps_of_bands(carry), events).run();
}

std::optional<Failure> predict_shifted_windows(JobWindows& windows, int threads, const ConstantShift& shift,
                                               const WindowEvents& events) {
  PathCarry carry;
  return WindowRun(windows, threads, steps_of_shifted_prediction(shift, carry), events).run();
}

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  WritingCarry carry{Rewriter(options.write), std::move(corrected)};
  const WindowSteps steps = steps_of_compensation(carry, attribution);
  return WindowRun(windows, options.threads, steps, events).run();
}

std::optional<Failure> verify_windows(JobWindows& windows, int threads, ProgramReader& corrected,
                                      bool attribution, const WindowEvents& events) {
  std::array<bool, 3> ignored{};
  VerifyingCarry carry{CorrectedMoves([&](Program& window) {
    if (!corrected.next()) return false;
    corrected.take_window(window);
    ignore_axes(window, ignored);
    return true;
  })};
  WindowSteps steps = steps_of_verification(carry, attribution);
  steps.write = [&, match = steps.write](const Job& job, WindowWork& work) {
    if (!job.program.moves.empty()) ignored = job.program.moves.front().ignored;
    match(job, work);
  };
  if (auto failure = WindowRun(windows, threads, steps, events).run()) return failure;
  if (auto failure = match_end(carry.lines, carry.found)) return failure;
  return carry.missed;
}

void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind) {
  enum { reading, looking, in_order };
  Turns turns(threads, in_order);
  bool all_read = false;
  turns.run(threads > 1 ? 2 : 1, [&] {
    Program window;
    for (bool found = true; found;) {
      const std::size_t item = turns.take();
      const auto read = [&] {
        all_read = all_read || !reader.next();
        found = !all_read;
        if (!found) return;
        first(reader.window());
        reader.take_window(window);
      };
      if (!turns.in_turn(reading, item, read)) return;
      if (found && !turns.in_turn(looking, item, [&] { behind(window); })) return;
    }
  });
}

}  // namespace counterflex
