#pragma once
/// Windows of a program on their way through the stages of compensation, several at once.
#include <exception>
#include <functional>
#include <string>

#include "counterflex/compensation/compensate_windows.hpp"
#include "window_record.hpp"

namespace counterflex {

/// A window under way. An error waits until all windows before it are done.
struct Flight {
  JobWindow window{};
  WindowWork work{};
  std::size_t index = 0;  ///< of the window, from 0
  bool is_read = false;
  bool given_up = false;  ///< a window before it has failed
  std::exception_ptr error{};
  Matching matching{};  ///< of a window that is verified
  bool waits = false;   ///< its waypoints are so many that they are solved, portion by portion, when its turn comes

  // Where windows are recorded, or taken over from records.
  enum class Role { compensated, passed, before_part } role = Role::compensated;
  std::string bytes{};  ///< of its record, or none
  std::string start{};  ///< `digest_of_start`
  bool is_planned = false;
  std::optional<WindowRecord> record{};  ///< none: there is none that is of use

  bool goes_on() const { return !given_up && !error && !work.failed(); }
};

/// What is done with a window, in the order of a pipeline. Windows come in their order to all but `plan` and
/// `verify`, which look at any number of them at once.
struct WindowStages {
  using Stage = std::function<void(const Job&, Flight&)>;
  std::function<bool(Flight&)> next;  ///< reads it; false: there is none
  std::function<void(const Job&)> read;
  Stage begin, plan, write, verify;
  std::function<void(const Job&)> begun;          ///< all before this window is done
  std::function<void(const Job&, Flight&)> done;  ///< it is, or has failed
};

/// Takes all windows through `stages`, to the first that fails: its failure is returned, and what is thrown
/// is thrown on when its turn comes. A window is not looked at where one before it has failed in a stage
/// that takes them in order.
std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowStages& stages);

/// Solves what has been matched, unless that waits.
void solve_or_wait(const Job& job, bool attribution, Flight& flight);

/// Gives out the waypoints of the window whose turn has come. Returns the first failure of the tolerance.
std::optional<Failure> give_out(const Job& job, bool attribution, const WindowEvents& events, Flight& flight);

/// The stages of a run that hears `events`.
WindowStages stages_of_compensation(JobWindows& windows, CarriedState& carried, bool attribution,
                                    const WindowEvents& events);

}  // namespace counterflex
