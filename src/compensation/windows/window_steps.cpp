#include "compensation/windows/window_steps.hpp"

#include "compensation/shift/commands.hpp"
#include "compensation/solve/commands.hpp"
#include "counterflex/compensation/constant_shift.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Where the last move ends; nothing where it comes from an unknown position.
std::optional<Vector3> last_command(const Job& job, const Program& corrected) {
  if (corrected.moves.empty()) return std::nullopt;
  const Move& last = corrected.moves.back();
  if (last.cycle || !all_known(last.known_start) || !all_known(last.known_end)) return std::nullopt;
  return target_of(job, last);
}

void follow_window(const Job& job, WindowWork& work) {
  work.result.failure = follow_branch(job, work.actuators);
}

void plan_window(const Job& job, WindowWork& work) {
  Compensation& result = work.result;
  result.failure = decimals_failure(job.program, job.path, job.options);
  if (!result.failure) follow_window(job, work);
  if (work.failed()) return;
  work.plan = plan(job);
  result.failure = work.plan.failure;
}

void write_window(const Job& job, WritingCarry& carry, WindowWork& work) {
  Compensation& result = work.result;
  result.failure = turns_failure(job, work.actuators, carry.path.actuators);
  if (work.failed()) return;
  const std::vector<MoveEdit> edits = Emitter(job, work.plan, carry.emitter, result).run();
  if (work.failed()) return;
  result.counts = carry.rewriter.write(job.program, edits);
  result.text = std::move(result.counts.text);
  carry.corrected.read(result.text);
  carry.corrected.take_window(result.corrected);
  if (!job.program.moves.empty()) ignore_axes(result.corrected, job.program.moves.front().ignored);
  work.command = carry.path.command;
  carry.path.command = last_command(job, result.corrected);
}

void take(const Job& job, Matching matching, WindowWork& work) {
  work.plan = {};  // its memory is not needed where the pieces are solved
  work.pieces = std::move(matching.pieces);
  work.result.failure = std::move(matching.failure);
  if (!work.failed()) work.result.failure = stated_turns_failure(job, work.pieces);
}

void match_written(const Job& job, WindowWork& work) {
  CorrectedMoves found(work.result.corrected);
  OtherLines lines;
  Matching matching = match_window(job, work.plan, lines, found);
  if (!matching.failure) matching.failure = match_end(lines, found);
  take(job, std::move(matching), work);
}

// Where the plan fails the ends are not known. What is written may be right in spite of that.
void plan_ends(const Job& job, WindowWork& work) {
  follow_window(job, work);
  if (work.failed()) return;
  work.plan = plan(job);
  if (work.plan.failure) work.plan.segments.assign(work.plan.segments.size(), {});
}

void carry_path(const Job& job, PathCarry& carry, WindowWork& work) {
  work.command = carry.command;
  if (!work.pieces.empty()) carry.command = work.pieces.back().commanded.end;
  if (!work.failed()) work.result.failure = turns_failure(job, work.actuators, carry.actuators);
}

// Solves `pieces_of` the original program forward.
template <typename PiecesOf>
WindowSteps steps_of_original(const Questions& questions, PathCarry& carry, PiecesOf pieces_of) {
  return {.questions = questions, .write = [&carry, pieces_of](const Job& job, WindowWork& work) {
            work.pieces = pieces_of(job);
            carry_path(job, carry, work);
          }};
}

}  // namespace

WindowSteps steps_of_compensation(WritingCarry& carry, bool attribution) {
  return {.questions = {.attribution = attribution},
          .prepare = plan_window,
          .write = [&carry](const Job& job, WindowWork& work) { write_window(job, carry, work); },
          .match = match_written,
          .judge =
              [](WindowWork& work, const std::optional<Failure>& missed) {
                if (!work.failed()) work.result.failure = missed;
              }};
}

WindowSteps steps_of_verification(VerifyingCarry& carry, bool attribution) {
  return {.questions = {.attribution = attribution},
          .prepare = plan_ends,
          .write =
              [&carry](const Job& job, WindowWork& work) {
                Matching matching = match_window(job, work.plan, carry.lines, carry.found);
                work.result.corrected_moves = matching.changed_without_piece;
                take(job, std::move(matching), work);
                carry_path(job, carry.path, work);
              },
          .judge =
              [&carry](WindowWork&, const std::optional<Failure>& missed) {
                if (!carry.missed) carry.missed = missed;
              }};
}

std::optional<Failure> predict_windows(JobWindows& windows, int threads, const WindowEvents& events) {
  PathCarry carry;
  WindowSteps steps = steps_of_original({.attribution = true, .inside = false}, carry, original_pieces);
  steps.prepare = follow_window;
  return run_windows(windows, threads, steps, events);
}

std::optional<Failure> predict_bands(JobWindows& windows, int threads, const WindowEvents& events) {
  PathCarry carry;
  return run_windows(windows, threads,
                     steps_of_original({.before = false, .bands = true}, carry, original_moves), events);
}

// The way there is not followed: only where the text ends is carried.
std::optional<Failure> predict_shifted_windows(JobWindows& windows, int threads, const ConstantShift& shift,
                                               const WindowEvents& events) {
  PathCarry carry;
  const auto shifted_pieces = [&shift](const Job& job) {
    std::vector<Piece> pieces = original_pieces(job);
    shift_pieces(job, shift, pieces);
    return pieces;
  };
  return run_windows(windows, threads,
                     steps_of_original({.before = false, .inside = false}, carry, shifted_pieces), events);
}

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  WritingCarry carry{Rewriter(options.write), std::move(corrected)};
  return run_windows(windows, options.threads, steps_of_compensation(carry, attribution), events);
}

std::optional<Failure> verify_windows(JobWindows& windows, int threads, ProgramReader& corrected,
                                      bool attribution, const WindowEvents& events) {
  VerifyingCarry carry{CorrectedMoves([&](Program& window) {
    if (!corrected.next()) return false;
    corrected.take_window(window);
    ignore_axes(window, windows.input().ignored);
    return true;
  })};
  const WindowSteps steps = steps_of_verification(carry, attribution);
  if (auto failure = run_windows(windows, threads, steps, events)) return failure;
  if (auto failure = match_end(carry.lines, carry.found)) return failure;
  return carry.missed;
}

}  // namespace counterflex
