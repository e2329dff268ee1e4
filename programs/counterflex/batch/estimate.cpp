#include "batch/estimate.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "batch/job_process.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "process/signals.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double longest_try = 2;          // s
constexpr double least_share = 0.001;      // of a program: smaller shares give no usable time
constexpr double process_seconds = 0.005;  // overhead of a job

/// A temporary folder, removed with its content.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto made = system::make_temporary_folder();
    if (!made) throw InputError(ErrorKind::transient_io, {}, "cannot make a temporary folder");
    path_ = *made;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The time for `job`, extrapolated from the part done in a few seconds. A signal stops it and is
/// returned in `stopped`.
double tried_seconds(const BatchJob& job, const AwaitedSignals& signals, std::optional<int>& stopped) {
  const TemporaryFolder folder;
  const JobOrder order{.key = job.key, .folder = folder.path()};
  Workers workers;
  workers.start(0, order.text(), [&](const SendLine& send) { do_job(job, order, send); });
  const auto begun = Clock::now();
  double share = 0, elapsed = 0;
  for (bool ended = false; !ended && !stopped && elapsed < longest_try;) {
    const auto events = workers.wait(&signals, 100);
    stopped = signals.take();
    elapsed = std::chrono::duration<double>(Clock::now() - begun).count();
    for (const WorkerEvent& event : events) {
      ended = ended || event.end;
      if (const auto done = news_of(event.line).done) share = *done;
    }
    if (ended) share = 1;
  }
  workers.end_all(500);
  return elapsed / std::max(share, least_share);
}

struct JobKind {
  double work = 0;
  std::size_t jobs = 0;
  const BatchJob* largest = nullptr;
};

/// Groups jobs by machine, method and whether causes are computed.
using JobKinds = std::map<std::tuple<std::string, Method, bool>, JobKind>;

JobKinds kinds_of(const Batch& batch) {
  JobKinds kinds;
  for (const BatchJob& job : batch.jobs) {
    const bool causes = job.options.report || job.options.plot;
    JobKind& kind = kinds[{job.options.machine, job.options.method, causes}];
    kind.work += job.work;
    ++kind.jobs;
    if (kind.largest == nullptr || job.work > kind.largest->work) kind.largest = &job;
  }
  return kinds;
}

double seconds_of(const JobKinds& kinds, std::optional<int>& stopped) {
  const AwaitedSignals signals;
  double seconds = 0;
  for (const auto& [name, kind] : kinds) {
    if (stopped) break;
    seconds += tried_seconds(*kind.largest, signals, stopped) * kind.work / kind.largest->work +
               process_seconds * static_cast<double>(kind.jobs);
  }
  return seconds;
}

}  // namespace

double estimated_seconds(const Batch& batch) {
  std::optional<int> stopped;
  const double seconds = seconds_of(kinds_of(batch), stopped);
  if (stopped) end_by(*stopped);  // the temporary folder has been removed
  return seconds;
}

}  // namespace counterflex::cli
