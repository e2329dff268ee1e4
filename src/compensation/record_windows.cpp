#include <algorithm>

#include "counterflex/compensation/recorded_windows.hpp"
#include "record_file.hpp"
#include "windows_under_way.hpp"

namespace counterflex {
namespace {

// What the run that takes the records over will meet, too, and say; anything else is this run's own trouble.
bool is_of_the_job(const InputError& error) {
  return error.exit() != Exit::usage && error.exit() != Exit::transient_io && error.exit() != Exit::internal;
}

class WindowRecorder {
 public:
  WindowRecorder(JobWindows& windows, CarriedState& carried, bool attribution, const RecordedPart& part,
                 const WindowEvents& events, RecordWriter& file)
      : windows_(windows),
        carried_(carried),
        attribution_(attribution),
        part_(part),
        events_(events),
        file_(file) {}

  WindowStages stages() {
    using Member = void (WindowRecorder::*)(const Job&, Flight&);
    const auto stage = [this](Member work) {
      return [this, work](const Job& job, Flight& flight) { (this->*work)(job, flight); };
    };
    return {.next = [this](Flight& flight) { return next(flight); },
            .read = events_.read,
            .begin = stage(&WindowRecorder::begin),
            .plan = stage(&WindowRecorder::plan),
            .write = stage(&WindowRecorder::write),
            .verify = stage(&WindowRecorder::verify),
            .begun = [](const Job&) {},
            .done = stage(&WindowRecorder::done)};
  }

 private:
  using Role = Flight::Role;

  bool next(Flight& flight) {
    if (next_byte_ >= part_.bytes.end || !windows_.next(flight.window)) return false;
    const std::size_t begin = next_byte_;
    next_byte_ += flight.window.program.text.size();
    flight.role = role_of({begin, next_byte_});
    flight.record.reset();
    return true;
  }

  // What the windows of the part are entered with comes from the one before them, and from those that have
  // said an axis last: where its correction hardly changes, what they have written stays.
  Role role_of(Span window) const {
    if (window.begin >= part_.bytes.begin) return Role::compensated;
    const bool leads_to_part = window.end >= part_.bytes.begin && window.end < part_.bytes.end;
    const bool said_last = std::ranges::any_of(part_.last_words, [&](const std::optional<std::size_t>& at) {
      return at && *at >= window.begin && *at < window.end;
    });
    return leads_to_part || said_last ? Role::before_part : Role::passed;
  }

  void begin(const Job& job, Flight& flight) {
    if (flight.role == Role::compensated) {
      flight.record.emplace();
      flight.record->start = digest_of_start(job, carried_.nominal);
    }
    begin_window(job, carried_, flight.work);
  }

  void plan(const Job& job, Flight& flight) {
    if (flight.role != Role::passed) plan_window(job, flight.work);
  }

  void write(const Job& job, Flight& flight) {
    if (flight.role == Role::passed) return pass(job);
    const WindowState entry = state_of(carried_);
    write_window(job, carried_, flight.work);
    if (!flight.record) return;
    flight.record->entry = entry;
    flight.record->exit = state_of(carried_);
  }

  // The original's text: what it leaves is near to what the corrected one does. Which correction holds there
  // is not known.
  void pass(const Job& job) {
    carried_.corrected.read(carried_.rewriter.write(job.program, {}).text);
    carried_.emitter = {.held = carried_.rewriter.state().held};
  }

  void verify(const Job& job, Flight& flight) {
    if (!flight.record) return;
    verify_window(job, attribution_, flight.work);
    if (flight.work.failed()) return;
    WindowRecord& record = *flight.record;
    record.index = flight.index;
    record.bytes = job.program.text.size();
    record.commands = digest_of_commands(flight.work.result.corrected);
    record.result = std::move(flight.work.result);
    flight.bytes = to_bytes(record);
    flight.work.result = std::move(record.result);
    flight.record.reset();
  }

  void done(const Job& job, Flight& flight) {
    if (flight.role != Role::compensated) return;
    events_.begun(job);
    if (!flight.work.failed()) file_.add(flight.bytes);
    events_.solved(job, flight.work.result.waypoints);
    events_.done(job, flight.work.result);
  }

  JobWindows& windows_;
  CarriedState& carried_;
  const bool attribution_;
  const RecordedPart& part_;
  const WindowEvents& events_;
  RecordWriter& file_;
  std::size_t next_byte_ = 0;
};

}  // namespace

FileWriter record_windows(JobWindows& windows, const CompensationOptions& options, TextReader corrected,
                          bool attribution, const RecordedPart& part, const std::string& run,
                          const std::string& file, const WindowEvents& events) {
  CarriedState carried{Rewriter(options.write), std::move(corrected)};
  RecordWriter writer(file, run);
  WindowRecorder recorder(windows, carried, attribution, part, events, writer);
  try {
    run_windows(windows, options.threads, recorder.stages());
  } catch (const InputError& error) {
    if (!is_of_the_job(error)) throw;
  }
  return writer.finish();
}

}  // namespace counterflex
