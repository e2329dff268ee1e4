#pragma once
/// Reads Heidenhain Klartext: linear moves and arcs in the plane XY are followed, all else for its state.
#include <map>
#include <string>

#include "counterflex/program/read_program.hpp"
#include "program/klartext_labels.hpp"
#include "program/klartext_lex.hpp"
#include "program/operation.hpp"

namespace counterflex {

/// Fills `program`, whose file and text are set. `tool_change_axes` are unknown after TOOL CALL. Throws
/// `InputError` with line and column.
void read_klartext(Program& program, const ReadOptions& options, const std::array<bool, 3>& tool_change_axes);

/// Whether the header of a corrected program stands in `text`.
bool is_corrected_klartext(std::string_view text);

/// The centre that CC has set for arcs, in mm.
struct KlartextPole {
  Vector3 centre_mm = Vector3::Zero();
  std::array<AxisWord, 2> words{};
  bool just_set = false;  ///< no arc about it since: the words may be changed for the next one
};

/// Q203 of a drilling cycle: the height of the surface, which its other heights count from.
struct KlartextSurface {
  double z_mm = 0;
  AxisWord word{};
  bool just_set = false;  ///< no hole since: the first one has its word
};

/// What a control remembers from block to block.
struct KlartextState {
  std::optional<LengthUnit> unit;
  std::array<bool, 3> known{};
  std::array<std::size_t, 3> taken_away{};  ///< moves until the machine moved the axis by itself, plus one
  Vector3 position_mm = Vector3::Zero();
  double feed_mm_min = 0;
  double tool_feed_mm_min = 0;  ///< F of TOOL CALL, for FAUTO
  bool feed_per_turn = false;   ///< M136: `feed_mm_min` is mm a turn
  double spindle_rpm = 0;
  long tool = 0;
  bool tool_along_z = true;
  std::optional<KlartextPole> pole;
  std::optional<Vector6> force;
  std::map<int, std::string> elsewhere;    ///< what places moves elsewhere, by a number of its own, and why
  std::array<bool, 9> datum_shift{};       ///< axes of XYZABCUVW that cycle 7 has shifted
  std::string preset;                      ///< number of cycle 247; empty: none yet
  bool cycle_acts_here = false;            ///< the cycle defined stays above the point where it is called
  std::optional<KlartextSurface> surface;  ///< of that cycle, where all of it goes along with its surface
  bool rounds_next = false;                ///< RND or CHF stands before the next move
  bool contour = false;                    ///< RL or RR acts
  bool after_contour = false;              ///< only moves along Z since the R0 that ended it
  int groups = 0;
  std::size_t run_begin = 0;  ///< index of the first move after the last that is not followed
};

struct KlartextReading {
  Program& program;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes;
  std::vector<LineStretch> doubtful;
  std::vector<int> polar;  ///< lines of the CC that arcs share with other blocks
  KlartextState state{};
  std::vector<KlartextWord> words{};
  CurrentOperation operation{};
  bool ended = false;
};

/// L, C, CR, CT and CP.
void read_klartext_motion(const KlartextBlock& block, KlartextReading& reading);

/// CP, an arc or a helix of an angle about the pole: it is held, and a shift moves the words of its CC, which
/// no other block uses.
void add_polar_arc(const KlartextBlock& block, KlartextReading& reading);

/// CC.
void read_klartext_pole(const KlartextBlock& block, KlartextReading& reading);

/// M words in a block of their own.
void read_klartext_codes(const KlartextBlock& block, KlartextReading& reading);

/// CYCL DEF and CYCL CALL.
void read_klartext_cycle(const KlartextBlock& block, KlartextReading& reading);

/// A block that moves the tool in a way that is not followed.
void add_unfollowed_move(const KlartextBlock& block, KlartextReading& reading, std::string why);

/// Whether the hole of `move` goes along with the correction that holds where its cycle was first called:
/// then the word of the surface is its Z. Else the surface is lost to the holes that follow, too.
bool hold_hole(KlartextReading& reading, Move& move);

/// The machine moves the axis by itself: nobody knows where to.
void take_away(KlartextReading& reading, std::size_t axis);

/// What a cycle called in place leaves unknown: the height.
void add_cycle_call(const KlartextBlock& block, KlartextReading& reading);

/// Why a block stays as it is, once for a run of equal reasons.
void leave_alone(KlartextReading& reading, int line, std::string why);

/// A move begun at the state before `block`.
Move begin_klartext_move(const KlartextBlock& block, KlartextReading& reading);

}  // namespace counterflex
