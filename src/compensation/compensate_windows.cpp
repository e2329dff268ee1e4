#include "counterflex/compensation/compensate_windows.hpp"

#include "windows_under_way.hpp"

namespace counterflex {

WindowStages stages_of_compensation(JobWindows& windows, CarriedState& carried, bool attribution,
                                    const WindowEvents& events) {
  return {
      .next = [&windows](Flight& flight) { return windows.next(flight.window); },
      .read = events.read,
      .begin = [&carried](const Job& job, Flight& flight) { begin_window(job, carried, flight.work); },
      .plan = [](const Job& job, Flight& flight) { plan_window(job, flight.work); },
      .write = [&carried](const Job& job, Flight& flight) { write_window(job, carried, flight.work); },
      .verify =
          [attribution](const Job& job, Flight& flight) {
            flight.matching = match_written(job, flight.work);
            solve_or_wait(job, attribution, flight);
          },
      .begun = events.begun,
      .done =
          [attribution, &events](const Job& job, Flight& flight) {
            const auto missed = give_out(job, attribution, events, flight);
            if (!flight.work.failed()) flight.work.result.failure = missed;
            events.done(job, flight.work.result);
          },
  };
}

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  CarriedState carried{Rewriter(options.write), std::move(corrected)};
  return run_windows(windows, options.threads, stages_of_compensation(windows, carried, attribution, events));
}

}  // namespace counterflex
