#pragma once
/// Reads Heidenhain Klartext. Lines and arcs are followed, also in polar coordinates and in shifted or
/// rotated coordinates. Of other blocks the reader follows the modal states.
#include <map>
#include <string>

#include "counterflex/program/read_program.hpp"
#include "program/klartext/labels.hpp"
#include "program/text/corners.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

/// The centre set by CC for arcs and polar coordinates, in mm.
struct KlartextPole {
  Vector3 centre_mm = Vector3::Zero();
  int normal = 2;  ///< axis normal to its plane
  std::array<PackedAxisWord, 3> words{};
  bool just_set = false;                       ///< not used yet: the words may be changed for the next arc
  bool must_stay = false;                      ///< a block that is not followed uses it: no arc may move it
  bool incremental = false;                    ///< the words are relative to the tool's position at `set_at`
  std::size_t set_at = 0;                      ///< number of moves read before it
  std::optional<double> radius_mm{}, angle{};  ///< of the last polar coordinates about it (mm, rad)
};

/// Q203 of a drilling cycle: the height of the surface, to which its other heights are relative.
struct KlartextSurface {
  double z_mm = 0;
  AxisWord word{};
  bool just_set = false;       ///< no hole since it was set
  bool of_definition = false;  ///< set by CYCL DEF, not by a line of its own
  bool repeatable = true;  ///< repeating that definition sets no parameter that the program has changed since
};

/// F: mm/min, or mm per turn; 0: unknown.
struct KlartextFeed {
  double mm = 0;
  bool per_turn = false;  ///< FU, or F under M136

  bool operator==(const KlartextFeed&) const = default;
};

/// The modal state of a control.
struct KlartextState {
  std::optional<LengthUnit> unit;
  std::array<bool, 3> known{};
  /// Moves read before the machine moved the axis by itself, plus one.
  std::array<std::size_t, 3> moved_by_machine{};
  Vector3 position_mm = Vector3::Zero();
  KlartextFeed feed, tool_feed;               ///< that of TOOL CALL is for FAUTO
  std::optional<bool> feed_per_turn = false;  ///< M136; empty: unknown
  bool plunges_slower = false;                ///< M103 F
  double spindle_rpm = 0;                     ///< 0: unknown
  bool spindle_off = false;                   ///< behind M5, or perhaps
  long tool = 0;
  bool tool_along_z = true;
  std::optional<KlartextPole> pole;
  std::optional<Vector6> force;
  /// Displacements of moves, by their own numbers, with the reason.
  std::map<int, std::string> displacements;
  std::array<bool, 9> unfollowed_shift{};  ///< axes of XYZABCUVW whose shift by cycle 7 is not followed
  Vector3 shift_mm = Vector3::Zero();      ///< by cycle 7
  double turn_rad = 0;                     ///< by cycle 10, about Z of the shifted coordinates
  std::size_t frame = 0;                   ///< index into Program::frames
  std::string preset;                      ///< number of cycle 247; empty: none yet
  bool basic_rotation_deleted = false;     ///< by M143
  bool cycle_acts_here = false;            ///< the defined cycle stays above the point at which it is called
  bool cycle_is_relative = false;          ///< all its heights are relative to the tool's position
  bool cycle_returns = false;              ///< such a cycle returns to its start
  bool takes_surface = false;              ///< all its heights are relative to Q203
  bool cycle_mills = false;                ///< such a cycle mills beside the point at which it is called
  bool calls_each = false;                 ///< M89: every move ends with the cycle, until M99
  /// Q200 and Q204 of that cycle, above the surface.
  std::optional<double> clearance_mm, second_clearance_mm;
  std::optional<double> depth_mm;             ///< Q201 of that cycle, its bottom above the surface
  double plunging_feed_mm_min = 0;            ///< Q206 of that cycle; 0: it does not drill, or not known
  std::optional<KlartextSurface> surface;     ///< surface of that cycle, if all of it shifts with the surface
  std::optional<CornerSize> corner;           ///< RND or CHF before the next move
  bool contour = false;                       ///< RL or RR is active
  CutterSide cutter_side = CutterSide::none;  ///< of that contour
  bool beside_contour = false;                ///< a move across has brought the tool to its side
  bool after_contour = false;                 ///< only moves along Z since the R0 that ended it
  int groups = 0;
  /// Index of the first move of the window after the last one that is not followed.
  std::size_t run_begin = 0;
};

struct KlartextReading {
  Program& program;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes;
  const KlartextOutline& outline;
  int place = 0;               ///< place of the block being read, as counted by the outline
  std::size_t moves_read = 0;  ///< since the begin of the program; counted by `add_move`
  KlartextState state{};
  std::vector<KlartextWord> words{};
  double feed_before_mm_min = 0;  ///< that acts before the block; 0: unknown
  CurrentOperation operation{};
  std::map<std::string, double, std::less<>> variables{};  ///< Q parameters with known values: "q5"
  std::string last_reason{};                               ///< reason of the last uncorrected block
  bool ended = false;
  int force_line = 0;  ///< line of the last comment (FORCE ...)
};

/// Reads a block with its comments. Throws `InputError` with line and column.
void read_statement(const KlartextBlock& block, KlartextReading& reading);

/// Reads the words behind the block's head. Q parameters with known values are evaluated. False if a word is
/// unknown. Throws `InputError` as `lex_klartext_words`.
bool read_words(const KlartextBlock& block, KlartextReading& reading);

/// The value of a number or, with ReadOptions::evaluate, of a Q parameter that is known: `squeezed_text` is
/// all of it. Empty if it is unknown.
std::optional<double> klartext_value(const KlartextBlock& block, KlartextReading& reading,
                                     std::string_view squeezed_text);

/// Stores the assignment of FN 0 to FN 8 or "Q1 =". An unknown value makes the parameter unknown.
void take_parameter(const KlartextBlock& block, KlartextReading& reading);

/// Whether the block being read may run never or several times.
bool may_skip_or_repeat(const KlartextReading& reading);

/// Whether the block being read may run never or several times, or '/' may skip it.
bool may_not_run(const KlartextBlock& block, const KlartextReading& reading);

/// Behind a block that may not run, states that it has changed since `before` are unknown until a block that
/// runs sets them. Coordinates that it has reset stay displaced.
void mark_changes_unknown(const KlartextState& before, KlartextState& now);

/// L, C, CR, CT, LP and CP.
void read_klartext_motion(const KlartextBlock& block, KlartextReading& reading);

/// C and CR with plain coordinates from a known start: C in the plane of its CC, CR in the plane XY. If the
/// arc is unknown, so is the end of the move. Throws `InputError` if the pole is not equally far from both
/// ends.
void read_klartext_arc(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// CT between known ends: the arc tangent to the move before it. False if the arc is unknown, is a line, or
/// has no length.
bool read_klartext_tangent_arc(KlartextReading& reading, Move& move);

/// The end of LP or CP about the pole, and the arc of CP. Returns why the block is not followed; empty if it
/// is.
std::string place_polar_end(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// The centre of an arc about the pole, and the words of CC if the arc may change them.
void set_centre(ArcMove& arc, const KlartextPole& pole, const Move& move, const KlartextReading& reading);

/// APPR and DEP.
void read_klartext_approach(const KlartextBlock& block, KlartextReading& reading);

/// RL and RR begin a contour, R0 ends it with its move and those along Z after it.
void follow_contour(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// F of the reading's words.
void read_klartext_feed(KlartextReading& reading);

/// F and S are unknown until a word gives them.
void forget_klartext_speeds(KlartextState& state);

/// The length of a word (mm).
double klartext_length_mm(const KlartextReading& reading, const KlartextWord& word);

/// Whether the next arc about the pole may change the words of its CC: no other block has used it, and it is
/// near.
bool has_own_words(const KlartextPole& pole, const KlartextReading& reading);

/// CC.
void read_klartext_pole(const KlartextBlock& block, KlartextReading& reading);

/// M words in a block without other words.
void read_klartext_codes(const KlartextBlock& block, KlartextReading& reading);

/// Begins or ends a displacement, which has a number of its own.
void set_displacement(KlartextReading& reading, int number, bool acts, const char* why);

/// A line of CYCL DEF 7 with the reading's words. `lexed`: all words are known.
void shift_datum(const KlartextBlock& block, bool lexed, KlartextReading& reading);

/// The line of CYCL DEF 10 with the angle: `rest` of it, squeezed.
void turn_frame(const KlartextBlock& block, std::string_view rest, KlartextReading& reading);

/// Ends shift and rotation.
void end_frame(KlartextReading& reading);

/// TRANS DATUM, MIRROR, ROTATION and SCALE: the coordinates are unknown. TRANS DATUM RESET ends that of TRANS
/// DATUM.
void read_transformation(const KlartextBlock& block, KlartextReading& reading);

/// CYCL DEF 247. Unknown if it may not run.
void define_preset(const KlartextBlock& block, KlartextReading& reading);

/// PRESET SELECT #3 as CYCL DEF 247. Coordinates are unknown behind the other forms of PRESET.
void read_preset(const KlartextBlock& block, KlartextReading& reading);

/// M143. Before the first move the work offset is that without the rotation, later coordinates are unknown.
void delete_basic_rotation(const KlartextBlock& block, KlartextReading& reading);

/// CYCL DEF and CYCL CALL.
void read_klartext_cycle(const KlartextBlock& block, KlartextReading& reading);

/// A block that moves the tool and is not followed.
void add_unfollowed_move(const KlartextBlock& block, KlartextReading& reading, std::string why);

/// Whether the hole at the end of `move` is shifted with its surface. The first hole behind the cycle's
/// definition uses the word of the surface as its Z. If the height at which the cycle leaves the tool is
/// known, the move is corrected in X and Y by its own end; otherwise it is held. If the result is false, the
/// surface is lost for later holes, too.
bool take_hole(KlartextReading& reading, Move& move);

/// What is not corrected of a hole that was taken.
void note_hole(const KlartextBlock& block, KlartextReading& reading, const Move& move);

/// The machine retracts along the tool by a distance that it has itself, as under M140 and PLANE with MB.
void retract_klartext(const KlartextBlock& block, KlartextReading& reading, const char* why);

/// The machine moves the axis by itself: its position is unknown.
void move_by_machine(KlartextReading& reading, std::size_t axis);

/// Q203, Q200, Q201 and Q204 = plain numbers, if the defined cycle uses them.
void read_cycle_parameter(const KlartextBlock& block, KlartextReading& reading);

/// Calls the cycle of an older control at the end of `move`, with which it is shifted.
void call_relative_cycle(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// The height is unknown after a cycle.
void add_cycle_call(const KlartextBlock& block, KlartextReading& reading);

/// Adds an uncorrected block with the reason `why`. Of a run of equal reasons only the first is added.
void note_uncorrected(KlartextReading& reading, int line, std::string why);

/// Adds each uncorrected block. `left.line` is a line of the text.
void add_uncorrected(KlartextReading& reading, LeftAlone left);

/// Begins a move in the state before `block`.
Move begin_klartext_move(const KlartextBlock& block, KlartextReading& reading);

/// Appends a move that was begun like this.
void add_move(KlartextReading& reading, Move move);

}  // namespace counterflex
