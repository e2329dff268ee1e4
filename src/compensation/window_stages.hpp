#pragma once
/// What becomes of a window between its job and its compensated text, stage by stage. A stage does nothing
/// where one before it has failed.
#include "counterflex/compensation/compensate.hpp"
#include "emit.hpp"
#include "plan.hpp"

namespace counterflex {

/// What compensating carries from window to window.
struct CarriedState {
  Rewriter rewriter;
  TextReader corrected;
  EmitterState emitter{};
  std::optional<NominalPlace> nominal{};  ///< where the window before ended; none: home
  std::optional<Vector3> command{};       ///< end of the last piece
};

/// A window on its way.
struct WindowWork {
  NominalTrack track{};
  Plan plan{};
  std::vector<KnownSegment> known{};  ///< by segment
  std::vector<Piece> pieces{};
  std::optional<Vector3> command{};  ///< end of the last piece of the window before
  Compensation result{};

  bool failed() const { return result.failure.has_value(); }
};

/// In the order of windows: checks decimals, follows the nominal machine along the window.
void begin_window(const Job& job, CarriedState& carried, WindowWork& work);

/// In any order.
void plan_window(const Job& job, WindowWork& work);

/// Text that has been written and read back.
struct TextRead {
  const std::string& text;
  const Program& program;
};

/// In the order of windows: writes the text and reads it back.
void write_window(const Job& job, CarriedState& carried, WindowWork& work);

/// The same where that very text has been written and read before.
void write_window(const Job& job, CarriedState& carried, WindowWork& work, const TextRead& read);

/// In any order: solves what was written forward.
void verify_window(const Job& job, bool attribution, WindowWork& work);

}  // namespace counterflex
