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
#include <utility>

#include "commands.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/shown_text.hpp"
#include "counterflex/files/utf8.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "signals.hpp"
#include "watch_claims.hpp"
#include "watch_failures.hpp"
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
  const nlohmann::ordered_json line{{"program", utf8_of_bytes(program)},
                                    {"output", output},
                                    {"exit", static_cast<int>(result.exit)},
                                    {"verdict", result.verdict},
                                    {"verdict_reason", result.verdict_reason},
                                    {"error", result.error},
                                    {"before_mm", or_null(result.before_mm)},
                                    {"after_mm", or_null(result.after_mm)}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string mm_text(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f} mm", *value, decimals) : "-";
}

std::string text_line(const std::string& program, const std::string& output, const WatchResult& result) {
  const std::string reason = result.verdict_reason.empty() ? "" : fmt::format(" ({})", result.verdict_reason);
  if (result.exit != Exit::done)
    return fmt::format("{}{}: {}: not written (exit status {})\n", result.verdict, reason, without_controls(program),
                       static_cast<int>(result.exit));
  return fmt::format("{}{}: {} -> {}: {} before, {} after\n", result.verdict, reason, without_controls(program), without_controls(output),
                     mm_text(result.before_mm, 3), mm_text(result.after_mm, 4));
}

/// Of all files of the folder one at a time, in the order in which they came.
class Watch {
 public:
  Watch(const Options& options, Console& console)
      : options_(options), console_(console), folder_(options.folder) {}

  Exit run();

 private:
  void add_what_is_there();
  void add(const std::string& name);
  void hear();
  void begin_next();
  void begin(const std::string& name);
  void refuse_taken(const Options& job);
  void fail(const std::string& path, const WatchResult& result);
  void end_job(const WatchResult& result);
  void tell(const std::string& program, const std::string& output, const WatchResult& result);
  void warn_of_older(const WatchResult& result);
  void add_failed_again();
  bool is_own(const std::string& path) const;
  bool is_done(const std::string& path);
  bool is_idle() const { return !job_ && due_.empty(); }
  int patience_ms() const;
  void wait();
  bool is_interrupted();
  void give_up();
  Exit run_on();

  const Options& options_;
  Console& console_;
  AwaitedSignals signals_;
  WatchedFolder folder_;
  AnyOf awaited_{signals_.descriptor(), folder_.descriptor()};
  std::deque<std::string> due_;      ///< names, each once
  std::optional<Options> job_;       ///< that is being done
  std::optional<std::string> sent_;  ///< its result
  pid_t process_ = 0;                ///< that does it; 0 until it says so
  std::optional<int> interrupt_;
  Workers workers_;
  OutputClaims claims_;
  WatchFailures failures_;
  FileStamps seen_;  ///< of the files that the job reads besides its program, before it did
  Exit first_failure_ = Exit::done;
};

/// What the watch itself writes into the folder. A corrected program is known by its header; by the name that
/// it has without -o, too.
bool Watch::is_own(const std::string& path) const {
  const bool named_so = !options_.output && fs::path(path).stem().extension() == ".comp";
  return named_so || has_corrected_header(path);
}

/// Whether there is a corrected program, of these bytes: its name is taken. What is wrong with the settings
/// is said when the program is begun.
bool Watch::is_done(const std::string& path) {
  try {
    const Options job = watch_job(options_, path);
    return is_corrected_from(watch_output(job), path, [this] { return is_interrupted(); }) &&
           !claims_.claim(job);
  } catch (const InputError&) {
    return false;
  }
}

/// All programs that are not done. To know that can take minutes, which an interrupt is not to wait for.
void Watch::add_what_is_there() {
  for (const std::string& name : folder_.names()) {
    if (is_interrupted()) return;
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
  for (std::size_t i = 0; !job_ && i < due_.size();) {
    const std::string name = due_[i], path = folder_.path_of(name);
    const bool busy = is_being_written(path);
    if (busy && options_.once) console_.note(path + ": it is being written; left for the next time\n");
    if (busy && !options_.once) {
      ++i;
      continue;
    }
    hear();  // that it was closed just now: no second time
    std::erase(due_, name);
    if (!busy) begin(name);
  }
}

/// Nothing where there is no program: it was taken away, it is still empty, or it is corrected already. What
/// is linked may come later.
void Watch::begin(const std::string& name) {
  const std::string path = folder_.path_of(name);
  failures_.erase(path);
  std::error_code error;
  if (fs::is_symlink(path, error) && !fs::exists(path, error)) failures_.add(path, stamps_of({path}), {});
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0 || error) return;
  if (is_own(path)) return console_.detail(path + ": a corrected program");
  seen_ = stamps_of(files_with_settings(options_, path));
  try {
    const Options job = watch_job(options_, path);
    seen_.merge(stamps_of(files_beside_program(job)));
    refuse_taken(job);
    job_ = job;
  } catch (const InputError& wrong) {
    return fail(path, {wrong.exit(), wrong.what(), {}, {}});
  }
  process_ = 0;
  workers_.start(0, [this](const SendLine& send) { do_watch_job(*job_, send); });
}

void Watch::refuse_taken(const Options& job) {
  const auto taken = claims_.claim(job);
  if (!taken) return;
  seen_.merge(stamps_of({taken->owner}));
  throw InputError(Exit::usage, {job.program},
                   fmt::format("its output would be {}, as that of {} is: give one of them another name, or "
                               "name outputs with {{name}}{{ext}}",
                               taken->path, taken->owner));
}

void Watch::fail(const std::string& path, const WatchResult& result) {
  const bool unreadable = ::access(path.c_str(), R_OK) != 0;
  if (unreadable) seen_.merge(stamps_of({path}));
  const bool may_pass = unreadable || result.exit == Exit::transient_io;
  failures_.add(path, std::exchange(seen_, {}), may_pass ? std::optional(pause_after_failure) : std::nullopt);
  tell(path, job_ ? watch_output(*job_) : "", result);
}

void Watch::end_job(const WatchResult& result) {
  if (result.exit == Exit::done)
    tell(job_->program, watch_output(*job_), result);
  else
    fail(job_->program, result);
  warn_of_older(result);
  job_.reset();
  sent_.reset();
}

void Watch::tell(const std::string& program, const std::string& output, const WatchResult& result) {
  const HeardSignals heard;  // nothing is under way
  if (first_failure_ == Exit::done) first_failure_ = result.exit;
  if (!result.error.empty()) console_.error(result.error);
  if (options_.json)
    write_result(json_line(program, output, result));
  else
    write_result(text_line(program, output, result));
}

/// A corrected program of an older text, under the name that this one's would have, is no correction of it.
void Watch::warn_of_older(const WatchResult& result) {
  std::error_code ignored;
  const std::string output = watch_output(*job_);
  if (result.exit == Exit::done || !fs::is_regular_file(output, ignored)) return;
  console_.warning(output, 0, fmt::format("is of an earlier run: {} failed now", job_->program));
  console_.finish_warnings();  // none is too many in a watch that goes on for weeks
}

/// A full disk, or a server that was away, need not be there for ever, and what is wrong is mended.
void Watch::add_failed_again() {
  if (failures_.empty() || options_.once) return;
  for (const std::string& program : failures_.take_due()) add(fs::path(program).filename().string());
}

/// For how long nothing can happen of which no event tells.
int Watch::patience_ms() const {
  constexpr int look_again_ms = 100;
  constexpr int folder_ms = 100 * look_again_ms;  // of which no event need tell that it has gone
  if (job_) return folder_ms;
  if (!due_.empty()) return look_again_ms;  // they are being written
  return failures_.empty() ? folder_ms : 10 * look_again_ms;
}

void Watch::wait() {
  for (WorkerEvent& event : workers_.wait(awaited_.descriptor(), patience_ms()))
    if (event.ended) {
      if (!sent_) sweep_after(process_, *job_);
      end_job(watch_result(sent_, *job_, event.status));
    } else if (const pid_t process = process_of_watch_job(event.line)) {
      process_ = process;
    } else {
      sent_ = std::move(event.line);
    }
}

bool Watch::is_interrupted() {
  if (!interrupt_) interrupt_ = signals_.take();
  return interrupt_.has_value();
}

/// The job ends itself, or else it is ended: either way nothing stays of what it was writing.
void Watch::give_up() {
  constexpr int patience_at_end_ms = 700;
  workers_.end_all(patience_at_end_ms);
  if (job_ && process_ != 0) sweep_after(process_, *job_);
}

Exit Watch::run_on() {
  add_what_is_there();
  while (!is_interrupted()) {
    hear();
    add_failed_again();
    if (!job_) begin_next();
    if (options_.once && is_idle()) return first_failure_;
    wait();
  }
  give_up();
  return static_cast<Exit>(status_of(*interrupt_));
}

Exit Watch::run() {
  try {
    return run_on();
  } catch (const InputError&) {
    give_up();
    throw;
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
