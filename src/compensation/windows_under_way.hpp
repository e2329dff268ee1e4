#pragma once
/// Windows of a program on their way through the stages of compensation, several at once.
#include <exception>
#include <functional>

#include "counterflex/compensation/compensate_windows.hpp"
#include "window_stages.hpp"

namespace counterflex {

/// A window under way. An error waits until all windows before it are done.
struct WindowInProgress {
  JobWindow input{};
  WindowWork work{};
  bool is_read = false;
  bool given_up = false;  ///< a window before it has failed
  std::exception_ptr error{};
  Matching matching{};  ///< of a window that is verified
  bool waits = false;   ///< its waypoints are so many that they are solved, portion by portion, when its turn comes

  bool goes_on() const { return !given_up && !error && !work.failed(); }
};

/// What is done with a window, in the order of a pipeline. Windows come in their order to all but `plan` and
/// `verify`, which look at any number of them at once.
struct WindowStages {
  using Stage = std::function<void(const Job&, WindowInProgress&)>;
  std::function<bool(WindowInProgress&)> next;  ///< reads it; false at the end
  std::function<void(const Job&)> read;
  Stage begin, plan, write, verify;
  std::function<void(const Job&)> begun;          ///< all before this window is done
  std::function<void(const Job&, WindowInProgress&)> done;  ///< it is, or has failed
};

/// Takes all windows through `stages`, to the first that fails: its failure is returned, and what is thrown
/// is thrown on when its turn comes. A window is not looked at where one before it has failed in a stage
/// that takes them in order.
std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowStages& stages);

/// Solves what has been matched, unless that waits.
void solve_or_wait(const Job& job, bool attribution, WindowInProgress& window);

/// Gives out the waypoints of the window whose turn has come. Returns the first failure of the tolerance.
std::optional<Failure> give_out(const Job& job, bool attribution, const WindowEvents& events,
                                WindowInProgress& window);

}  // namespace counterflex
