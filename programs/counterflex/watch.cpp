#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "commands.hpp"
#include "counterflex/files/input_error.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "watch_job.hpp"
#include "watched_folder.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds pause_after_failure{30};

/// Signals as something to wait for: what asks the watch to end, and the end of a child.
class AwaitedSignals {
 public:
  AwaitedSignals() {
    ::sigset_t awaited;
    ::sigemptyset(&awaited);
    ::sigaddset(&awaited, SIGCHLD);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction action {};
      // Who started this with signals ignored (nohup) means it; blocked they would come all the same.
      if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
        ::sigaddset(&awaited, signal);
    }
    ::sigprocmask(SIG_BLOCK, &awaited, &before_);
    descriptor_ = ::signalfd(-1, &awaited, SFD_NONBLOCK | SFD_CLOEXEC);
    std::signal(SIGIO, SIG_IGN);  // that somebody opens a file just looked at
  }
  ~AwaitedSignals() {
    ::close(descriptor_);
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  AwaitedSignals(const AwaitedSignals&) = delete;
  AwaitedSignals& operator=(const AwaitedSignals&) = delete;

  int descriptor() const { return descriptor_; }
  const sigset_t& before() const { return before_; }

  /// The signal that asks to end, if one has come.
  std::optional<int> ending() {
    signalfd_siginfo info{};
    while (::read(descriptor_, &info, sizeof info) == sizeof info)
      if (info.ssi_signo != SIGCHLD) return static_cast<int>(info.ssi_signo);
    return std::nullopt;
  }

 private:
  sigset_t before_{};
  int descriptor_ = -1;
};

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
  void end_child(Exit exit);
  void tell(const Options& job, Exit exit) const;
  void add_failed_again();
  bool is_own(const std::string& path) const;
  bool is_idle() const { return !child_ && due_.empty(); }
  void wait() const;

  const Options& options_;
  Console& console_;
  AwaitedSignals signals_;
  WatchedFolder folder_;
  std::deque<std::string> due_;  ///< names, each once
  std::optional<WatchChild> child_;
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

/// All programs whose corrected program is missing, or is not of their bytes.
void Watch::add_what_is_there() {
  for (const std::string& name : folder_.names()) {
    const std::string path = folder_.path_of(name);
    if (!may_be_program(name, options_.patterns) || is_own(path)) continue;
    if (!is_corrected_from(watch_output(watch_job(options_, path)), path)) add(name);
  }
}

void Watch::add(const std::string& name) {
  if (may_be_program(name, options_.patterns) && std::find(due_.begin(), due_.end(), name) == due_.end())
    due_.push_back(name);
}

void Watch::hear() {
  const WatchedFolder::News news = folder_.read();
  for (const std::string& name : news.names) add(name);
  if (news.lost) add_what_is_there();
}

/// Begins with the first file that is complete; those that are still being written keep their turn.
void Watch::begin_next() {
  for (auto name = due_.begin(); !child_ && name != due_.end();) {
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
  child_.emplace(watch_job(options_, path), console_, signals_.before());
}

void Watch::end_child(Exit exit) {
  const Options job = child_->job();
  child_.reset();
  if (first_failure_ == Exit::done) first_failure_ = exit;
  if (exit == Exit::transient_io && !options_.once) {
    failed_.insert(fs::path(job.program).filename().string());
    try_again_ = Clock::now() + pause_after_failure;
  }
  tell(job, exit);
}

void Watch::tell(const Options& job, Exit exit) const {
  const std::string output = watch_output(job);
  if (options_.json) {
    const nlohmann::ordered_json line{
        {"program", job.program}, {"output", output}, {"exit", static_cast<int>(exit)}};
    write_result(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  } else if (exit == Exit::done) {
    write_result(fmt::format("{} -> {}\n", job.program, output));
  }
}

/// A full disk, or a server that was away, need not be there for ever.
void Watch::add_failed_again() {
  if (failed_.empty() || Clock::now() < try_again_) return;
  for (const std::string& name : std::exchange(failed_, {})) add(name);
}

/// Until something happens, or may be worth another look.
void Watch::wait() const {
  constexpr int look_again_ms = 100;
  int most_ms = -1;
  if (!child_ && !due_.empty()) most_ms = look_again_ms;
  if (!child_ && most_ms < 0 && !failed_.empty()) most_ms = 10 * look_again_ms;
  std::array<pollfd, 2> awaited{pollfd{signals_.descriptor(), POLLIN, 0}, {folder_.descriptor(), POLLIN, 0}};
  ::poll(awaited.data(), awaited.size(), most_ms);
}

Exit Watch::run() {
  for (;;) {
    if (const auto signal = signals_.ending()) {
      if (child_) child_->interrupt();
      return static_cast<Exit>(*signal == SIGTERM ? 128 + SIGTERM : static_cast<int>(Exit::interrupted));
    }
    if (!options_.once) hear();
    if (Exit exit{}; child_ && child_->has_ended(console_, exit)) end_child(exit);
    add_failed_again();
    if (!child_) begin_next();
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
  std::error_code error;
  for (const auto& output : {options.output, options.report, options.plot})
    if (output && !fs::is_directory(*output, error))
      throw InputError(Exit::usage, {*output},
                       "--output, --report and --plot of watch name folders that exist");
  if (options.output && fs::equivalent(*options.output, options.folder, error))
    throw InputError(Exit::usage, {*options.output},
                     "corrected programs would replace their originals: name another folder");
  const MachineInput machine = read_machine_input(options);
  read_tool_lengths(options, &machine.machine);
  read_force_input(options);
}

}  // namespace

Exit run_watch(const Options& options, Console& console) {
  check_watch(options);
  Watch watch(options, console);
  if (!options.once) console.detail(fmt::format("watching {}", options.folder));
  return watch.run();
}

}  // namespace counterflex::cli
