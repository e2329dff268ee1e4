#include "counterflex/compensation/compensate_windows.hpp"

#include "windows_under_way.hpp"

namespace counterflex {
namespace {

WindowStages stages_of_compensation(JobWindows& windows, CarriedState& carried, bool attribution,
                                    const WindowEvents& events) {
  return {
      .next = [&windows](WindowInProgress& window) { return windows.next(window.input); },
      .read = events.read,
      .begin = [&carried](const Job& job,
                          WindowInProgress& window) { begin_window(job, carried, window.work); },
      .plan = [](const Job& job, WindowInProgress& window) { plan_window(job, window.work); },
      .write = [&carried](const Job& job,
                          WindowInProgress& window) { write_window(job, carried, window.work); },
      .verify =
          [attribution](const Job& job, WindowInProgress& window) {
            window.matching = match_written(job, window.work);
            solve_or_wait(job, attribution, window);
          },
      .begun = events.begun,
      .done =
          [attribution, &events](const Job& job, WindowInProgress& window) {
            const auto missed = give_out(job, attribution, events, window);
            if (!window.work.failed()) window.work.result.failure = missed;
            events.done(job, window.work.result);
          },
  };
}

}  // namespace

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  CarriedState carried{Rewriter(options.write), std::move(corrected)};
  return run_windows(windows, options.threads, stages_of_compensation(windows, carried, attribution, events));
}

}  // namespace counterflex
