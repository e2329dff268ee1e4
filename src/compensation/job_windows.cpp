#include "counterflex/compensation/job_windows.hpp"

#include "tool_orientations.hpp"

namespace counterflex {

struct JobWindows::State {
  const RunInput input;
  ProgramReader& reader;
  NominalPlace nominal{};  ///< where the window before ended
  ForceTail tail{};        ///< of the window before
  PathEnd start{};
  Toolpath path{};
  std::optional<PathForces> forces{};

  void build() {
    ignore_axes(reader.window(), input.ignored);
    path = build_toolpath(reader.window(), input.frames, start);
    NominalPlace at_end = nominal;
    const std::vector<Matrix3> R_MT = tool_orientations(input, reader.window(), path, at_end);
    forces.emplace(input.source, reader.window(), path, R_MT, tail);
    end_of_window = std::move(at_end);
  }

  bool next() {
    leave();
    if (!reader.next()) return false;
    build();
    while (!forces->is_final() && reader.extend()) build();
    return true;
  }

  /// What the window leaves to the next one.
  void leave() {
    if (!forces) return;
    start = path.end;
    tail = forces->tail();
    nominal = std::move(end_of_window);
  }

  Job job(const Program& program, const Toolpath& of_window, const PathForces& on_window) const {
    return {input.model, program, of_window, on_window, input.options, input.read, input.tools, input.starts};
  }

  NominalPlace end_of_window{};
};

JobWindows::JobWindows(const RunInput& input, ProgramReader& reader)
    : state_(new State{input, reader, home_of(input.model)}) {}

JobWindows::~JobWindows() = default;

bool JobWindows::next() {
  return state_->next();
}

Job JobWindows::job() const {
  const State& s = *state_;
  return s.job(s.reader.window(), s.path, *s.forces);
}

bool JobWindows::next(JobWindow& window) {
  State& s = *state_;
  if (!s.next()) return false;
  s.leave();
  s.reader.take_window(window.program);
  std::swap(window.path, s.path);
  window.forces = std::move(s.forces);
  s.forces.reset();
  return true;
}

Job JobWindows::job(const JobWindow& window) const {
  return state_->job(window.program, window.path, *window.forces);
}

}  // namespace counterflex
