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
      .verify = [attribution](const Job& job,
                              Flight& flight) { verify_window(job, attribution, flight.work); },
      .begun = events.begun,
      .done = [&events](const Job& job, Flight& flight) { events.done(job, flight.work.result); },
  };
}

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  CarriedState carried{Rewriter(options.write), std::move(corrected)};
  return run_windows(windows, options.threads, stages_of_compensation(windows, carried, attribution, events));
}

}  // namespace counterflex
