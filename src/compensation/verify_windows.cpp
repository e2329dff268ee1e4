#include "counterflex/compensation/verify_windows.hpp"

#include "windows_under_way.hpp"

namespace counterflex {
namespace {

// Where the plan fails the ends are not known: what is written may be right for all that.
void plan_ends(const Job& job, WindowWork& work) {
  if (work.failed()) return;
  Plan found = plan(job, work.track);
  if (found.failure) return;
  work.ways = planned_ways(job, found);
}

class WindowVerifier {
 public:
  WindowVerifier(JobWindows& windows, ProgramReader& corrected, bool attribution, const WindowEvents& events)
      : windows_(windows), attribution_(attribution), events_(events), found_([this, &corrected](Program& window) {
          if (!corrected.next()) return false;
          corrected.take_window(window);
          ignore_axes(window, ignored_);
          return true;
        }) {}

  WindowStages stages() {
    using Member = void (WindowVerifier::*)(const Job&, WindowInProgress&);
    const auto stage = [this](Member work) {
      return [this, work](const Job& job, WindowInProgress& window) { (this->*work)(job, window); };
    };
    return {.next = [this](WindowInProgress& window) { return windows_.next(window.input); },
            .read = events_.read,
            .begin = stage(&WindowVerifier::begin),
            .plan = [](const Job& job, WindowInProgress& window) { plan_ends(job, window.work); },
            .write = stage(&WindowVerifier::match),
            .verify = stage(&WindowVerifier::solve),
            .begun = events_.begun,
            .done = stage(&WindowVerifier::done)};
  }

  // Behind the last window.
  std::optional<Failure> finish() {
    if (auto failure = match_end(lines_, found_)) return failure;
    return missed_;
  }

 private:
  void begin(const Job& job, WindowInProgress& window) {
    window.work.track = track(job, nominal_.value_or(home_of(job.model)));
    window.work.result.failure = window.work.track.failure;
    nominal_ = window.work.track.end;
  }

  void match(const Job& job, WindowInProgress& window) {
    if (!job.program.moves.empty()) ignored_ = job.program.moves.front().ignored;
    window.matching = match_window(job, window.work.track, window.work.ways, lines_, found_);
    window.work.command = command_;
    if (!window.matching.pieces.empty()) command_ = window.matching.pieces.back().commanded.end;
  }

  void solve(const Job& job, WindowInProgress& window) { solve_or_wait(job, attribution_, window); }

  void done(const Job& job, WindowInProgress& window) {
    const auto missed = give_out(job, attribution_, events_, window);
    if (!missed_) missed_ = missed;
    events_.done(job, window.work.result);
  }

  JobWindows& windows_;
  const bool attribution_;
  const WindowEvents& events_;
  std::array<bool, 3> ignored_{};
  CorrectedMoves found_;
  OtherLines lines_;
  std::optional<NominalPlace> nominal_;
  std::optional<Vector3> command_;
  std::optional<Failure> missed_;
};

}  // namespace

std::optional<Failure> verify_windows(JobWindows& windows, const CompensationOptions& options,
                                      ProgramReader& corrected, bool attribution,
                                      const WindowEvents& events) {
  WindowVerifier verifier(windows, corrected, attribution, events);
  if (auto failure = run_windows(windows, options.threads, verifier.stages())) return failure;
  return verifier.finish();
}

Compensation verify(const Job& job, const Program& corrected, bool attribution) {
  WindowWork work;
  work.track = track(job, home_of(job.model));
  work.result.failure = work.track.failure;
  plan_ends(job, work);
  if (work.failed()) return std::move(work.result);
  CorrectedMoves found(corrected);
  OtherLines lines;
  Matching matching = match_window(job, work.track, work.ways, lines, found);
  if (!matching.failure) matching.failure = match_end(lines, found);
  solve_matched(job, attribution, matching, work);
  if (!work.failed()) work.result.failure = tolerance_failure(job, work.result.waypoints);
  return std::move(work.result);
}

}  // namespace counterflex
