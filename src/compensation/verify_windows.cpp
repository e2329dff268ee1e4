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
  work.known = std::move(found.known);
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
    using Member = void (WindowVerifier::*)(const Job&, Flight&);
    const auto stage = [this](Member work) {
      return [this, work](const Job& job, Flight& flight) { (this->*work)(job, flight); };
    };
    return {.next = [this](Flight& flight) { return windows_.next(flight.window); },
            .read = events_.read,
            .begin = stage(&WindowVerifier::begin),
            .plan = [](const Job& job, Flight& flight) { plan_ends(job, flight.work); },
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
  void begin(const Job& job, Flight& flight) {
    flight.work.track = track(job, nominal_.value_or(home_of(job.model)));
    flight.work.result.failure = flight.work.track.failure;
    nominal_ = flight.work.track.end;
  }

  void match(const Job& job, Flight& flight) {
    if (!job.program.moves.empty()) ignored_ = job.program.moves.front().ignored;
    flight.matching = match_window(job, flight.work.track, flight.work.ways, lines_, found_);
    flight.work.command = command_;
    if (!flight.matching.pieces.empty()) command_ = flight.matching.pieces.back().commanded.end;
  }

  void solve(const Job& job, Flight& flight) { solve_or_wait(job, attribution_, flight); }

  void done(const Job& job, Flight& flight) {
    const auto missed = give_out(job, attribution_, events_, flight);
    if (!missed_) missed_ = missed;
    events_.done(job, flight.work.result);
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
