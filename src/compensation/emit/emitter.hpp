#pragma once
/// From a plan to the edits of a program's text.
#include "compensation/plan/arc_fit.hpp"
#include "compensation/plan/plan.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// What holds where the tool is, from move to move and from window to window.
struct EmitterState {
  Vector3 correction = Vector3::Zero();  ///< target minus wanted position, M (m)
  Vector3 turn = Vector3::Zero();        ///< commanded against wanted orientation: rotation vector (rad, M)
  bool correction_known = false;
  std::array<bool, 3> holds{};  ///< program axes that carry it
  bool doubtful = false;  ///< a block made a position unknown that carries the correction, and it still is
  int group = 0;          ///< contour group that is being emitted
  TextPosition held{};    ///< of the emitted text
  /// Why the last block that is not followed is not: of the windows before. Empty without such a block.
  std::string why_fixed{};
};

/// The motion that a contour group makes in the plane: a turn about Z, and a shift (program coordinates, mm).
struct GroupMotion {
  Vector3 about = Vector3::Zero(), shift = Vector3::Zero();
  double turn = 0;
  Vector3 shift_at(const Vector3& p_mm) const;
};

/// Goes through the moves of a window in order, keeps the correction that holds where the tool is, and what
/// the emitted text holds.
class Emitter {
 public:
  /// `result` gets the failure, the counts of moves, what is left alone, and narrowed contours.
  Emitter(const Job& job, const Plan& plan, EmitterState& state, Compensation& result)
      : job_(job), plan_(plan), out_(result), state_(state), solver_(job) {}

  /// Edits for all moves: segments as planned; moves that go nowhere keep the correction that holds there;
  /// moves made before all axes are known take that of the first position that is (look-ahead of 64 blocks).
  /// Arcs are fitted to what the text holds before them; holes get the correction at their bottom, contour
  /// groups one rigid motion; a held move keeps the correction at its start. Where one cannot be
  /// held the emission fails (ErrorKind::program_text).
  std::vector<MoveEdit> run();

 private:
  using Index = std::optional<std::size_t>;  ///< of a segment, where a move has one

  /// How a move is corrected: all of it by itself, in some axes or without its force, or as another one.
  enum class Extent { whole, in_part, held };

  /// What a move that is not split misses: inside of it (m), and of the orientation at its end (rad).
  struct UnsplitMiss {
    double position = 0, turn = 0;
  };

  // emit.cpp
  void emit_move(std::size_t m, Index s);
  void emit_segment(std::size_t s);
  void emit_line(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit, UnsplitMiss& miss);
  void finish_segment(const Segment& segment, const PlannedSegment& planned, const UnsplitMiss& miss,
                      MoveEdit edit);
  /// A point of the text for a command at a fraction of the move.
  Via via_of(const Move& move, const TargetCommand& command, double u) const;
  double put_jump(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit);
  Vector3 correction_that_can_be_written(const Move& move, const Vector3& correction) const;
  Vector3 correction_where_held(const Move& move, const Vector3& correction) const;

  struct EndHeights {
    double start_mm, end_mm;
  };
  double set_height_inside(std::size_t s, const Vector3& end_mm, MoveEdit& edit);
  std::optional<EndHeights> end_heights(std::size_t s) const;
  CornerEnds flat_parts_mm(std::size_t s, const EndHeights& heights) const;
  double corner_height_mm(std::size_t s, const EndHeights& heights) const;

  // emit_arc.cpp
  void emit_arc(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit, UnsplitMiss& miss);
  ArcTask arc_task(const Segment& segment, const PlannedSegment& planned,
                   const CorrectionCurve& stretch) const;
  void put_one_arc(const ArcTask& task, MoveEdit& edit, UnsplitMiss& miss);
  void keep_turn_limits(const ArcTask& task, const FittedArc& fit, UnsplitMiss& miss);

  // emit_held.cpp
  void emit_fixed(std::size_t m);
  std::string why_fixed(const Move& move) const;
  MoveEdit shifted(std::size_t m, const Vector3& shift) const;
  void emit_rigid(std::size_t m, Index s);
  void keep_standing_axes(const Move& move, MoveEdit& edit);
  void emit_doubtful(std::size_t m);
  void leave_pending_alone();

  // emit_group.cpp
  void emit_group(std::size_t m, Index s);
  bool begin_group(std::size_t m, Index s);
  bool is_in_xy(std::size_t m) const;
  bool group_may_turn(std::size_t m) const;
  bool find_group_motion(std::size_t m, std::size_t s);
  std::string words_beside(std::size_t begin, std::size_t end);
  Vector3 group_shift_mm(const Move& move, Index s, double height) const;
  void divide_by_height(const Move& move, std::size_t s, MoveEdit& edit) const;
  Vector3 shifted_centre(const Move& move, const Vector3& shift) const;
  void check_step(const Move& move, const Vector3& before_mm);

  // emit_position.cpp
  void emit_first_known(std::size_t m);
  std::optional<Vector3> hold_position(const Move& move);
  void emit_hole(std::size_t m);
  double retract_mm(const Move& move, double shift);
  struct PositionCorrection {
    Vector3 shift, turn;  // M (m, rad)
  };
  std::optional<PositionCorrection> solve_position(const Vector3& wanted, const Move& move);
  void give_to_pending();
  void leave_far_pending_alone(const Move& move);

  // Corrections as shifts of the text, program coordinates (mm).
  std::size_t index_of(const Segment& segment) const {
    return static_cast<std::size_t>(&segment - job_.path.segments.data());
  }
  std::size_t index_of(const Move& move) const {
    return static_cast<std::size_t>(&move - job_.program.moves.data());
  }
  const WorkFrame& frame(const Move& move) const { return job_.path.frames[move.frame]; }
  Vector3 shift_mm(const Move& move, const Vector3& correction) const;
  Vector3 correction_of(const Move& move, const Vector3& shift_mm) const;
  Vector3 held_shift_mm(const Move& move) const;  ///< zero on axes that hold none
  void hold(const Vector3& correction);           ///< on all axes
  bool rounds_to_nothing(const Move& move, std::size_t axis, double shift_mm) const;

  // The text's position, before and after a move.
  void come_to(const Move& move);
  TextPosition before(const Move& move);
  void go_through(const Move& move, const Via& via, TextPosition& held) const;
  void put(MoveEdit edit, Extent extent);  ///< the next edit
  void pass(const Move& move);             ///< a move without an edit

  void list(const Move& move, std::string why) { out_.left_alone.push_back({move.line, std::move(why)}); }
  void list_held_words(const Move& move, const Vector3& miss);
  void leave_alone(const Move& move);
  bool keeps_correction(const Move& move) const;
  void refuse(const Move& move, std::string what);

  const Job& job_;
  const Plan& plan_;
  Compensation& out_;
  std::vector<MoveEdit> edits_;
  std::size_t next_segment_ = 0;
  std::vector<std::size_t> pending_;  // moves before all axes are known
  EmitterState& state_;
  std::optional<std::size_t> held_for_;      // the move in whose coordinates the held position is
  bool group_in_xy_ = false;                 // the contour group that is being emitted
  std::optional<GroupMotion> group_motion_;  // none: it holds the correction with which it was entered
  Vector3 start_turn_ = Vector3::Zero();     // of the correction, where the segment begins in the text (rad)
  Vector3 end_turn_ = Vector3::Zero();       // the same at its end
  TextPosition piece_held_{};                // where the pieces of the move that is being fitted have come
  PlaceSolver solver_;
};

}  // namespace counterflex
