#include <fmt/format.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "commands.hpp"
#include "counterflex/files/input_error.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "signals.hpp"
#include "watch_job.hpp"
#include "watched_folder.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds pause_after_failure{30};

/// Several descriptors to wait for as one: it can be read where one of them can.
class AnyOf {
 public:
  AnyOf(std::initializer_list<int> descriptors) : descriptor_(::epoll_create1(EPOLL_CLOEXEC)) {
    for (const int descriptor : descriptors) {
      epoll_event event{};
      event.events = EPOLLIN;
      if (::epoll_ctl(descriptor_, EPOLL_CTL_ADD, descriptor, &event) == 0) continue;
      throw InputError(Exit::transient_io, {},
                       fmt::format("cannot wait for files: {}", std::strerror(errno)));
    }
  }
  ~AnyOf() { ::close(descriptor_); }
  AnyOf(const AnyOf&) = delete;
  AnyOf& operator=(const AnyOf&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

nlohmann::ordered_json or_null(const std::optional<double>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json();
}

std::string json_line(const std::string& program, const std::string& output, const WatchResult& result) {
  const nlohmann::ordered_json line{{"program", program},
                                    {"output", output},
                                    {"exit", static_cast<int>(result.exit)},
                                    {"error", result.error},
                                    {"before_mm", or_null(result.before_mm)},
                                    {"after_mm", or_null(result.after_mm)}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Of all files of the folder one at a time, in the order in which they came.
class Watch {
 public:
  Watch(const Options& options, Console& console)
      : options_(options), console_(console), folder_(options.folder) {
    add_what_is_there();
  }

  Exit run();

 private:
  using Clock = std::chrono::steady_clock;

  void add_what_is_there();
  void add(const std::string& name);
  void hear();
  void begin_next();
  void begin(const std::string& name);
  void end_job(const WatchResult& result);
  void tell(const std::string& program, const std::string& output, const WatchResult& result);
  void add_failed_again();
  bool is_own(const std::string& path) const;
  bool is_done(const std::string& path) const;
  bool is_idle() const { return !job_ && due_.empty(); }
  int patience_ms() const;
  void wait();

  const Options& options_;
  Console& console_;
  AwaitedSignals signals_;
  WatchedFolder folder_;
  AnyOf awaited_{signals_.descriptor(), folder_.descriptor()};
  std::deque<std::string> due_;      ///< names, each once
  std::optional<Options> job_;       ///< that is being done
  std::optional<std::string> sent_;  ///< its result
  Workers workers_;
  std::set<std::string> failed_;  ///< where another try may help
  Clock::time_point try_again_{};
  Exit first_failure_ = Exit::done;
};

/// What the watch itself writes into the folder. A corrected program is known by its header; by the name that
/// it has without -o, too.
bool Watch::is_own(const std::string& path) const {
  const bool named_so = !options_.output && fs::path(path).stem().extension() == ".comp";
  return named_so || has_corrected_header(path);
}

/// Whether there is a corrected program, of these bytes. What is wrong with the settings is said when the
/// program is begun.
bool Watch::is_done(const std::string& path) const {
  try {
    return is_corrected_from(watch_output(watch_job(options_, path)), path);
  } catch (const InputError&) {
    return false;
  }
}

/// All programs that are not done.
void Watch::add_what_is_there() {
  for (const std::string& name : folder_.names()) {
    const std::string path = folder_.path_of(name);
    if (!may_be_program(name, options_.patterns) || is_own(path)) continue;
    if (!is_done(path)) add(name);
  }
}

void Watch::add(const std::string& name) {
  if (may_be_program(name, options_.patterns) && std::find(due_.begin(), due_.end(), name) == due_.end())
    due_.push_back(name);
}

void Watch::hear() {
  const WatchedFolder::News news = folder_.read();
  if (options_.once) return;
  for (const std::string& name : news.names) add(name);
  if (news.lost) add_what_is_there();
}

/// Begins with the first file that is complete; those that are still being written keep their turn.
void Watch::begin_next() {
  for (auto name = due_.begin(); !job_ && name != due_.end();) {
    const std::string path = folder_.path_of(*name);
    const bool busy = is_being_written(path);
    if (busy && options_.once) console_.note(path + ": it is being written; left for the next time\n");
    if (busy && !options_.once) {
      ++name;
      continue;
    }
    const std::string taken = *name;
    name = due_.erase(name);
    if (!busy) begin(taken);
  }
}

/// Nothing where there is no program: it was taken away, it is still empty, or it is corrected already.
void Watch::begin(const std::string& name) {
  const std::string path = folder_.path_of(name);
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0 || error) return;
  if (is_own(path)) return console_.detail(path + ": a corrected program");
  failed_.erase(name);
  try {
    job_ = watch_job(options_, path);
  } catch (const InputError& wrong) {
    return tell(path, "", {wrong.exit(), wrong.what(), {}, {}});
  }
  workers_.start(0, [this](const SendLine& send) { do_watch_job(*job_, send); });
}

void Watch::end_job(const WatchResult& result) {
  if (result.exit == Exit::transient_io && !options_.once) {
    failed_.insert(fs::path(job_->program).filename().string());
    try_again_ = Clock::now() + pause_after_failure;
  }
  tell(job_->program, watch_output(*job_), result);
  job_.reset();
  sent_.reset();
}

void Watch::tell(const std::string& program, const std::string& output, const WatchResult& result) {
  const HeardSignals heard;  // nothing is under way
  if (first_failure_ == Exit::done) first_failure_ = result.exit;
  if (!result.error.empty()) console_.error(result.error);
  if (options_.json)
    write_result(json_line(program, output, result));
  else if (result.exit == Exit::done)
    write_result(fmt::format("{} -> {}: {:.3f} mm before, {:.4f} mm after\n", program, output,
                             result.before_mm.value_or(0), result.after_mm.value_or(0)));
}

/// A full disk, or a server that was away, need not be there for ever.
void Watch::add_failed_again() {
  if (failed_.empty() || Clock::now() < try_again_) return;
  for (const std::string& name : std::exchange(failed_, {})) add(name);
}

/// For how long nothing can happen of which no event tells; -1: for ever.
int Watch::patience_ms() const {
  constexpr int look_again_ms = 100;
  if (job_) return -1;
  if (!due_.empty()) return look_again_ms;  // they are being written
  return failed_.empty() ? -1 : 10 * look_again_ms;
}

void Watch::wait() {
  for (WorkerEvent& event : workers_.wait(awaited_.descriptor(), patience_ms()))
    if (event.ended)
      end_job(watch_result(sent_, *job_, event.status));
    else
      sent_ = std::move(event.line);
}

Exit Watch::run() {
  constexpr int patience_at_end_ms = 700;
  for (;;) {
    if (const auto signal = signals_.take()) {
      workers_.end_all(patience_at_end_ms);
      return static_cast<Exit>(status_of(*signal));
    }
    hear();
    add_failed_again();
    if (!job_) begin_next();
    if (options_.once && is_idle()) return first_failure_;
    wait();
  }
}

/// What would be wrong with every program is said before the first one comes.
void check_watch(const Options& options) {
  std::vector<std::string> read = options.forces;
  read.push_back(options.machine);
  if (options.tool_table) read.push_back(*options.tool_table);
  if (std::find(read.begin(), read.end(), "-") != read.end())
    throw InputError(Exit::usage, {},
                     "standard input (-) can be read once, not for every program of a folder");
  refuse_shared_outputs(options);
  const MachineInput machine = read_machine_input(options);
  read_tool_lengths(options, &machine.machine);
  read_force_input(options);
}

}  // namespace

Exit run_watch(const Options& options, Console& console) {
  check_watch(options);
  std::signal(SIGIO, SIG_IGN);  // that somebody opens a file which is just being looked at
  Watch watch(options, console);
  if (!options.once) console.detail(fmt::format("watching {}", options.folder));
  return watch.run();
}

}  // namespace counterflex::cli
