#include "counterflex/compensation/recorded_windows.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "counterflex/files/bytes.hpp"
#include "record_file.hpp"
#include "windows_under_way.hpp"

namespace counterflex {
namespace {

std::size_t index_in(const std::string& record) {
  return BytesIn(record).get<std::size_t>();
}

// Whether waypoints can be of that window: a record may have been changed together with its hash.
bool can_be_of(const Job& job, const std::vector<Waypoint>& waypoints) {
  return std::ranges::all_of(waypoints, [&](const Waypoint& w) {
    const bool has_place = w.segment == no_segment || w.segment < job.path.segments.size();
    return has_place && std::isfinite(w.weight) && std::isfinite(w.s) && w.before.allFinite() && w.after.allFinite() &&
           w.correction.allFinite() && w.wrench.allFinite();
  });
}

}  // namespace

struct RecordedWindows::Impl {
  std::string run;
  std::vector<std::string> files{};  // by the first window in them
  std::size_t next_file = 0;
  std::optional<RecordReader> reader{};
  std::optional<std::string> ahead{};
  std::size_t taken = 0, compensated = 0;

  void look_through(const std::vector<std::string>& paths) {
    std::vector<std::pair<std::size_t, std::string>> found;
    for (const std::string& path : paths) {
      check_record_file(path, run);
      const auto first = RecordReader(path, run).next();
      if (first) found.emplace_back(index_in(*first), path);
    }
    std::ranges::sort(found);
    for (auto& file : found) files.push_back(std::move(file.second));
  }

  bool read_ahead() {
    for (;;) {
      if (reader && (ahead = reader->next())) return true;
      reader.reset();
      if (next_file == files.size()) return false;
      reader.emplace(files[next_file++], run);
    }
  }

  // Windows are asked for in their order; the record may be none.
  std::string of_window(std::size_t index) {
    while (!ahead || index_in(*ahead) < index)
      if (!read_ahead()) return {};
    return index_in(*ahead) == index ? *std::exchange(ahead, std::nullopt) : std::string();
  }
};

RecordedWindows::RecordedWindows(const std::vector<std::string>& files, const std::string& run)
    : impl_(new Impl{.run = run}) {
  impl_->look_through(files);
}

RecordedWindows::~RecordedWindows() = default;

std::size_t RecordedWindows::taken() const {
  return impl_->taken;
}

std::size_t RecordedWindows::compensated() const {
  return impl_->compensated;
}

namespace {

// Takes over what is recorded; what is not is compensated.
class WindowTaker {
 public:
  WindowTaker(WindowStages compensating, CarriedState& carried, RecordedWindows::Impl& recorded)
      : compensating_(std::move(compensating)), carried_(carried), recorded_(recorded) {}

  WindowStages stages() {
    using Member = void (WindowTaker::*)(const Job&, Flight&);
    const auto stage = [this](Member work) {
      return [this, work](const Job& job, Flight& flight) { (this->*work)(job, flight); };
    };
    WindowStages stages = compensating_;
    stages.next = [this](Flight& flight) { return next(flight); };
    stages.begin = stage(&WindowTaker::begin);
    stages.plan = stage(&WindowTaker::plan);
    stages.write = stage(&WindowTaker::write);
    stages.verify = stage(&WindowTaker::verify);
    stages.done = stage(&WindowTaker::done);
    return stages;
  }

 private:
  bool next(Flight& flight) {
    flight.record.reset();
    flight.bytes = recorded_.of_window(flight.index);
    return compensating_.next(flight);
  }

  void begin(const Job& job, Flight& flight) {
    if (!flight.bytes.empty()) flight.start = digest_of_start(job, carried_.nominal);
    compensating_.begin(job, flight);
  }

  void plan(const Job& job, Flight& flight) {
    flight.record = window_record_of(std::exchange(flight.bytes, {}));
    const bool fits = flight.record && flight.record->start == flight.start &&
                      flight.record->bytes == job.program.text.size() &&
                      can_be_of(job, flight.record->result.waypoints);
    if (!fits) flight.record.reset();
    flight.is_planned = !fits || last_differed_;
    if (flight.is_planned) compensating_.plan(job, flight);
  }

  void write(const Job& job, Flight& flight) {
    if (flight.record && !is_entered_as_recorded(job, *flight.record)) {
      flight.record.reset();
      last_differed_ = true;
      if (!flight.is_planned) compensating_.plan(job, flight);
    }
    if (!flight.record) return compensating_.write(job, flight);
    take(job, flight);
  }

  void take(const Job& job, Flight& flight) {
    last_differed_ = false;
    WindowRecord& record = *flight.record;
    flight.work.plan = {};
    Compensation& result = flight.work.result = std::move(record.result);
    read_back(job, carried_, result);
    if (digest_of_commands(result.corrected) != record.commands) return compensate_what_was_read(job, flight);
    go_on(job.program, exit_of(job.program, state_of(carried_), record.exit), carried_);
  }

  bool is_entered_as_recorded(const Job& job, const WindowRecord& record) const {
    const WindowState entry = state_of(carried_);
    return same_for(unread_by(job.program, entry, record.entry), entry, record.entry);
  }

  // The text is right, but after what stands before it a control goes otherwise than it was judged.
  void compensate_what_was_read(const Job& job, Flight& flight) {
    flight.record.reset();
    const Compensation read = std::exchange(flight.work.result, {});
    plan_window(job, flight.work);
    write_window(job, carried_, flight.work, {read.text, read.corrected});
  }

  void verify(const Job& job, Flight& flight) {
    if (!flight.record) compensating_.verify(job, flight);
  }

  void done(const Job& job, Flight& flight) {
    ++(flight.record ? recorded_.taken : recorded_.compensated);
    compensating_.done(job, flight);
  }

  const WindowStages compensating_;
  CarriedState& carried_;
  RecordedWindows::Impl& recorded_;
  // Whether the last window that had a record was entered otherwise: the next ones may be, too, and are
  // planned beforehand, side by side. What comes of them does not depend on it.
  std::atomic<bool> last_differed_ = false;
};

}  // namespace

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution, const WindowEvents& events,
                                          RecordedWindows& recorded) {
  CarriedState carried{Rewriter(options.write), std::move(corrected)};
  WindowTaker taker(stages_of_compensation(windows, carried, attribution, events), carried, recorded.impl());
  return run_windows(windows, options.threads, taker.stages());
}

}  // namespace counterflex
