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
  WindowRecorder(JobWindows& windows, CarriedState& carried, bool attribution, Span part,
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
    if (next_byte_ >= part_.end || !windows_.next(flight.window)) return false;
    const std::size_t begin = next_byte_;
    next_byte_ += flight.window.program.text.size();
    const bool leads_to_part = next_byte_ >= part_.begin && next_byte_ < part_.end;
    flight.role = begin >= part_.begin ? Role::compensated : leads_to_part ? Role::before_part : Role::passed;
    flight.record.reset();
    return true;
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
    if (flight.role == Role::before_part) carried_.emitter.held = carried_.rewriter.state().held;
    const WindowState entry = state_of(carried_);
    write_window(job, carried_, flight.work);
    if (!flight.record) return;
    flight.record->entry = entry;
    flight.record->exit = state_of(carried_);
  }

  // The original's text: what it leaves is near to what the corrected one does.
  void pass(const Job& job) { carried_.corrected.read(carried_.rewriter.write(job.program, {}).text); }

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
    events_.done(job, flight.work.result);
  }

  JobWindows& windows_;
  CarriedState& carried_;
  const bool attribution_;
  const Span part_;
  const WindowEvents& events_;
  RecordWriter& file_;
  std::size_t next_byte_ = 0;
};

}  // namespace

FileWriter record_windows(JobWindows& windows, const CompensationOptions& options, TextReader corrected,
                          bool attribution, Span part, const std::string& run, const std::string& file,
                          const WindowEvents& events) {
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
