#pragma once
/// What one window of a program leaves to the next, as data that can be kept and compared.
#include <string>

#include "window_stages.hpp"

namespace counterflex {

/// All that writing a window depends on besides its job and its plan, but for what its text is read with.
struct WindowState {
  EmitterState emitter{};
  TextState text{};
  std::optional<Vector3> command{};
};

WindowState state_of(const CarriedState& carried);

/// Goes on behind `window`, whose text has been read, as if it had been written here and had left `state`.
void go_on(const Program& window, const WindowState& state, CarriedState& carried);

/// What of the states around a window is none of its business: of canned cycles what none of its holes asks
/// for, and the number of a contour that it does not go on with. Whatever that is, the window's text is the
/// same, and it passes it on.
struct Unread {
  bool cycles = false;
  bool group = false;
};

/// For a window that is entered with `a` and might be entered with `b`.
Unread unread_by(const Program& window, const WindowState& a, const WindowState& b);

/// Whether both are the same for a window, to the last bit.
bool same_for(const Unread& unread, const WindowState& a, const WindowState& b);

/// What a window leaves that was entered with `entry`, where one that was entered with `entry_then`, the same
/// for it, has left `exit_then`.
WindowState exit_of(const Program& window, const WindowState& entry, const WindowState& exit_then);

void put_window_state(const WindowState& state, std::string& bytes);
WindowState get_window_state(class BytesIn& bytes);

/// A digest of the place on the nominal machine where the window begins, and of how this computer rounds: the
/// targets of a window depend on nothing else besides its job.
std::string digest_of_start(const Job& job, const std::optional<NominalPlace>& nominal);

/// A digest of what emitted text commands: of its moves, read anew, whatever lines they stand in.
std::string digest_of_commands(const Program& corrected);

}  // namespace counterflex
