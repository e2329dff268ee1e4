#pragma once
/// Reads Heidenhain Klartext: lines and arcs, also in polar coordinates and in shifted or turned ones, are followed, all
/// else for its state.
#include <map>
#include <string>

#include "counterflex/program/read_program.hpp"
#include "program/text/corners.hpp"
#include "program/klartext/labels.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

/// The centre that CC has set for arcs and polar coordinates, in mm.
struct KlartextPole {
  Vector3 centre_mm = Vector3::Zero();
  int normal = 2;  ///< axis across its plane
  std::array<PackedAxisWord, 3> words{};
  bool just_set = false;     ///< nothing has used it: the words may be changed for the next arc
  bool incremental = false;  ///< the words count from where the tool was at `set_at`
  std::size_t set_at = 0;    ///< moves read before it
  std::optional<double> radius_mm{}, angle{};  ///< of the last polar coordinates about it (mm, rad)
};

/// Q203 of a drilling cycle: the height of the surface, which its other heights count from.
struct KlartextSurface {
  double z_mm = 0;
  AxisWord word{};
  bool just_set = false;  ///< no hole since
  bool of_definition = false;  ///< CYCL DEF says it, no line of its own
  bool repeatable = true;      ///< to write that definition again sets nothing that the program has changed since
};

/// What a control remembers from block to block.
struct KlartextState {
  std::optional<LengthUnit> unit;
  std::array<bool, 3> known{};
  std::array<std::size_t, 3> taken_away{};  ///< moves read until the machine moved the axis by itself, plus one
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
  std::array<bool, 9> unfollowed_shift{};  ///< axes of XYZABCUVW that cycle 7 has shifted otherwise
  Vector3 shift_mm = Vector3::Zero();      ///< by cycle 7
  double turn_rad = 0;                     ///< by cycle 10, about Z of the shifted coordinates
  std::size_t frame = 0;                   ///< index into Program::frames
  std::string preset;                      ///< number of cycle 247; empty: none yet
  bool cycle_acts_here = false;            ///< the cycle defined stays above the point where it is called
  bool cycle_is_relative = false;          ///< all of it counts from where the tool stands
  bool cycle_returns = false;              ///< such a one leaves the tool where it began
  bool takes_surface = false;              ///< all its heights count from Q203
  bool calls_each = false;                 ///< M89: every move ends with the cycle, until M99
  std::optional<double> clearance_mm, second_clearance_mm;  ///< Q200 and Q204 of that cycle, above the surface
  std::optional<KlartextSurface> surface;  ///< of that cycle, where all of it goes along with its surface
  std::optional<CornerSize> corner;        ///< RND or CHF stands before the next move
  bool contour = false;                    ///< RL or RR acts
  bool beside_contour = false;             ///< the tool has come to its side by a move across
  bool after_contour = false;              ///< only moves along Z since the R0 that ended it
  int groups = 0;
  std::size_t run_begin = 0;  ///< index of the first move of the window after the last that is not followed
};

struct KlartextReading {
  Program& program;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes;
  const KlartextOutline& outline;
  int place = 0;               ///< of the block that is read, as the outline counts
  std::size_t moves_read = 0;  ///< since the program's begin; `add_move` counts
  KlartextState state{};
  std::vector<KlartextWord> words{};
  CurrentOperation operation{};
  std::map<std::string, double, std::less<>> variables{};  ///< Q parameters whose values are known: "q5"
  std::string last_reason{};  ///< for which a block was left alone
  bool ended = false;
};

/// A block with its comments. Throws `InputError` with line and column.
void read_statement(const KlartextBlock& block, KlartextReading& reading);

/// The words behind the block's head, into the reading's; Q parameters whose values are known are their values. False
/// where a word is not known. Throws `InputError` as `lex_klartext_words`.
bool read_words(const KlartextBlock& block, KlartextReading& reading);

/// Stores what FN 0 to FN 4, or "Q1 =", assigns; what is not known becomes unknown.
void take_parameter(const KlartextBlock& block, KlartextReading& reading);

/// Whether the block that is read may run often or not at all.
bool in_doubt(const KlartextReading& reading);

/// L, C, CR, CT, LP and CP.
void read_klartext_motion(const KlartextBlock& block, KlartextReading& reading);

/// The end of LP or CP about the pole, and the arc of CP. Why the block is not followed; empty where it is.
std::string place_polar_end(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// The centre of an arc about the pole, and the words of CC where the arc may change them.
void set_centre(ArcMove& arc, const KlartextPole& pole, const Move& move, const KlartextReading& reading);

/// APPR and DEP.
void read_klartext_approach(const KlartextBlock& block, KlartextReading& reading);

/// RL and RR begin a contour, R0 ends it with its move and those along Z after it.
void follow_contour(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// F among the reading's words.
void read_klartext_feed(KlartextReading& reading);

/// The length that a word says, mm.
double klartext_length_mm(const KlartextReading& reading, const KlartextWord& word);

/// Whether the next arc about the pole may change the words of its CC: nothing else has used it, and it stands near.
bool has_own_words(const KlartextPole& pole, const KlartextReading& reading);

/// CC.
void read_klartext_pole(const KlartextBlock& block, KlartextReading& reading);

/// M words in a block of their own.
void read_klartext_codes(const KlartextBlock& block, KlartextReading& reading);

/// What places moves elsewhere, by a number of its own: it acts from here on, or no longer.
void set_elsewhere(KlartextReading& reading, int number, bool acts, const char* why);

/// A line of CYCL DEF 7 with the reading's words; `lexed`: all of them are known.
void shift_datum(const KlartextBlock& block, bool lexed, KlartextReading& reading);

/// The line of CYCL DEF 10 with the angle: `rest` of it, squeezed.
void turn_frame(const KlartextBlock& block, std::string_view rest, KlartextReading& reading);

/// Neither shift nor turn acts any more.
void end_frame(KlartextReading& reading);

/// CYCL DEF and CYCL CALL.
void read_klartext_cycle(const KlartextBlock& block, KlartextReading& reading);

/// A block that moves the tool in a way that is not followed.
void add_unfollowed_move(const KlartextBlock& block, KlartextReading& reading, std::string why);

/// Whether the hole at the end of `move` goes along with its surface: the first one behind the cycle's definition has
/// the word of the surface as its Z. Where the height at which the cycle leaves the tool is known the move is corrected on
/// its own in X and Y, else it is held. False: the surface is lost to the holes that follow, too.
bool take_hole(KlartextReading& reading, Move& move);

/// The machine moves the axis by itself: nobody knows where to.
void take_away(KlartextReading& reading, std::size_t axis);

/// Q203, Q200 and Q204 = plain numbers, where the cycle defined takes them.
void read_cycle_parameter(const KlartextBlock& block, KlartextReading& reading);

/// Calls the cycle of an older control at the end of `move`, with which it goes along.
void call_relative_cycle(const KlartextBlock& block, KlartextReading& reading, Move& move);

/// What a cycle called in place leaves unknown: the height.
void add_cycle_call(const KlartextBlock& block, KlartextReading& reading);

/// Why a block stays as it is, once for a run of equal reasons.
void leave_alone(KlartextReading& reading, int line, std::string why);

/// The same, each time; `left.line` is one of the text.
void add_left_alone(KlartextReading& reading, LeftAlone left);

/// A move begun at the state before `block`.
Move begin_klartext_move(const KlartextBlock& block, KlartextReading& reading);

/// Puts a move that was begun so behind the others.
void add_move(KlartextReading& reading, Move move);

}  // namespace counterflex
