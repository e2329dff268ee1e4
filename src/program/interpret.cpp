#include "program/interpret.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/force_comment.hpp"
#include "program/remarks.hpp"

namespace counterflex {
namespace {

constexpr std::array<char, 3> axis_letters{'X', 'Y', 'Z'};

bool has_axis_word(const SortedBlock& sorted) {
  return sorted.word('X') != nullptr || sorted.word('Y') != nullptr || sorted.word('Z') != nullptr;
}

const Word& first_axis_word(const Block& block) {
  for (const Word& word : block.words)
    if (word.letter >= 'X') return word;
  return block.words.front();
}

void forget_all(ModalState& state) {
  state.known.fill(false);
}

void apply_comments(const Block& block, Reading& r) {
  for (const Span& comment : block.comments)
    if (const auto force = read_force_comment(r.program.text, r.program.file, block, comment))
      r.state.force = force;
}

void apply_feed_and_spindle(Reading& r) {
  const std::optional<LengthUnit> unit_before = r.state.unit;
  if (r.sorted.has(Action::inch)) r.state.unit = LengthUnit::inches;
  if (r.sorted.has(Action::mm)) r.state.unit = LengthUnit::millimetres;
  const bool per_turn = r.sorted.has(Action::feed_per_turn);
  if (per_turn || r.sorted.has(Action::feed_per_minute)) {
    if (per_turn != r.state.feed_per_turn || r.dialect.feed_mode_ends_feed) r.state.feed = 0;
    r.state.feed_per_turn = per_turn;
  }
  if (const Word* f = r.sorted.word('F')) {
    r.state.feed = f->value;
    r.state.feed_unit = r.dialect.feed_before_unit && unit_before ? unit_before : r.state.unit;
  }
  // The S of some controls' dwell is a number of turns.
  if (const Word* s = r.sorted.word('S'); s != nullptr && !r.sorted.has(Action::dwell))
    r.state.spindle_rpm = s->value;
}

void apply_tool_change(Reading& r) {
  if (!r.sorted.has(MAction::tool_change)) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (r.tool_change_axes[axis]) r.state.known[axis] = false;
}

/// A change of the length shifts Z of the program while the machine stands still.
void apply_tool_length(const Block& block, Reading& r) {
  const bool on = r.sorted.has(Action::tool_length);
  if (!on && !r.sorted.has(Action::no_tool_length)) return;
  std::optional<double> length;
  if (!on) length = 0;
  if (const Word* h = r.sorted.word('H'); on && h != nullptr) length = h->value;
  if (!length || length != r.state.tool_length) r.state.known[2] = false;
  r.state.tool_length = length;
  remark_tool_length(block, r);
}

std::size_t index_of_offset(Program& program, const std::string& name) {
  const auto found = std::find(program.work_offsets.begin(), program.work_offsets.end(), name);
  if (found == program.work_offsets.end()) program.work_offsets.push_back(name);
  return static_cast<std::size_t>(std::find(program.work_offsets.begin(), program.work_offsets.end(), name) -
                                  program.work_offsets.begin());
}

void apply_work_offset(Reading& r) {
  const FoundG* offset = r.sorted.find(Action::work_offset);
  if (offset == nullptr) return;
  const std::size_t index = index_of_offset(r.program, fmt::format("G{}", offset->word->value));
  if (index != r.state.work_offset) forget_all(r.state);
  r.state.work_offset = index;
}

void apply_path_mode(const Block& block, Reading& r) {
  if (r.sorted.has(Action::g61)) r.state.exact_stop = r.dialect.g61_is_exact_stop;
  if (r.sorted.has(Action::exact_stop)) r.state.exact_stop = true;
  if (r.sorted.has(Action::blend)) r.state.exact_stop = false;
  remark_path_mode(block, r);
}

void apply_motion_mode(Reading& r) {
  if (r.sorted.has(Action::end_motion))
    r.state.motion = r.dialect.motion_ends_with_g80 ? MotionMode::cancelled : MotionMode::rapid;
  if (r.sorted.has(Action::rapid)) r.state.motion = MotionMode::rapid;
  if (r.sorted.has(Action::feed)) r.state.motion = MotionMode::feed;
}

void check_can_move(const Block& block, const Reading& r) {
  const Word& word = first_axis_word(block);
  const auto fail = [&](const std::string& message) {
    refuse(r.program.file, block, word.span.begin, message);
  };
  if (r.state.motion == MotionMode::none)
    fail(fmt::format("{} without a motion: no G0 or G1 stands before it", word.letter));
  if (r.state.motion == MotionMode::cancelled)
    fail(fmt::format("{} without a motion: G80 ended it, and {} needs G0 or G1 anew", word.letter,
                     r.dialect.name));
  if (r.state.motion == MotionMode::doubtful)
    fail(fmt::format("{} without a motion: G0 or G1 stands in a block that '/' may skip", word.letter));
  if (!r.state.unit)
    fail(fmt::format("{} before the unit is known: program G20 or G21, or give mm or inch as the unit",
                     word.letter));
}

double feed_mm_min(const ModalState& state) {
  const double feed = state.feed * mm_per(state.feed_unit.value_or(*state.unit));
  return state.feed_per_turn ? feed * state.spindle_rpm : feed;
}

bool is_increments(const Reading& r, const Word& word) {
  return !word.point && r.options.integer_words == IntegerWords::increments &&
         r.dialect.integer_words_doubtful;
}

double length_mm(const Reading& r, const Word& word) {
  const LengthUnit unit = *r.state.unit;
  if (!is_increments(r, word)) return word.value * mm_per(unit);
  return word.value / (unit == LengthUnit::millimetres ? 1e3 : 1e4) * mm_per(unit);
}

/// Words with which inserted points would change what a block does.
void allow_changes(const Reading& r, Move& move) {
  const SortedBlock& b = r.sorted;
  const bool feed = move.motion == Motion::feed;
  const bool unit = b.has(Action::inch) || b.has(Action::mm);  // an F copied before it would change its unit
  const bool tool_length = b.has(Action::tool_length) || b.has(Action::no_tool_length);
  const bool acts_at_end = b.has(MAction::acts_after) || b.has(MAction::end) || b.has(MAction::tool_change) ||
                           b.has(MAction::machine);
  move.may_insert_words = !tool_length;
  move.may_split = feed && !move.exact_stop && !tool_length && !acts_at_end;
  const bool only_motion = b.g.empty() || (b.g.size() == 1 && b.g[0].code->group == Group::motion);
  const bool start_known = move.known_start[0] && move.known_start[1] && move.known_start[2];
  move.may_jump = start_known && move.feed_mm_min > 0 && !move.exact_stop && !acts_at_end && !unit &&
                  (feed ? move.may_split : only_motion);
}

void place_words(Reading& r, Move& move) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Word* word = r.sorted.word(axis_letters[axis]);
    if (word == nullptr) continue;
    move.words[axis] = AxisWord{word->number, word->decimals};
    r.state.position_mm[static_cast<Eigen::Index>(axis)] = length_mm(r, *word);
    r.state.known[axis] = true;
  }
}

void add_move(const Block& block, Reading& r) {
  check_can_move(block, r);
  Move move;
  move.line = block.line;
  move.block_index = r.program.block_count - 1;
  move.block = block.span;
  move.motion = r.state.motion == MotionMode::feed ? Motion::feed : Motion::rapid;
  move.unit = *r.state.unit;
  move.known_start = r.state.known;
  move.start_mm = r.state.position_mm;
  place_words(r, move);
  move.known_end = r.state.known;
  move.end_mm = r.state.position_mm;
  move.feed_mm_min = feed_mm_min(r.state);
  move.spindle_rpm = r.state.spindle_rpm;
  if (const Word* n = r.sorted.word('N')) move.block_number = static_cast<long>(n->value);
  move.offset = r.state.work_offset;
  move.force = r.state.force;
  move.block_delete = !empty(block.block_delete);
  move.exact_stop = r.state.exact_stop || r.sorted.has(Action::stop_once);
  allow_changes(r, move);
  r.program.moves.push_back(std::move(move));
}

/// G53, G28, G30: where the axes are afterwards, the machine knows and the program does not.
void leave_machine_move(const Block& block, Reading& r, const FoundG& found) {
  const bool reference = found.code->action == Action::reference_move;
  if (!reference && !has_axis_word(r.sorted))
    refuse(r.program.file, block, found.word->span.begin, "G53 has no axis word");
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (r.sorted.word(axis_letters[axis]) != nullptr) r.state.known[axis] = false;
  if (!has_axis_word(r.sorted)) forget_all(r.state);
  r.program.left_alone.push_back(
      {block.line, fmt::format("G{} moves to a position of the machine", found.word->value)});
}

/// Gives the axis words to the code that uses them.
void apply_axis_words(const Block& block, Reading& r) {
  const FoundG* machine = r.sorted.find(Action::machine_move);
  const FoundG* reference = r.sorted.find(Action::reference_move);
  const FoundG* dwell = r.sorted.find(Action::dwell);
  const FoundG* smooth = r.sorted.find(Action::smooth);
  const auto fail = [&](const FoundG& found, const std::string& message) {
    refuse(r.program.file, block, found.word->span.begin, message);
  };
  if (reference != nullptr &&
      (machine != nullptr || r.sorted.has(Action::rapid) || r.sorted.has(Action::feed)))
    fail(*reference, fmt::format("G{} stands beside another motion", reference->word->value));
  if (reference != nullptr) return leave_machine_move(block, r, *reference);
  if (machine != nullptr) return leave_machine_move(block, r, *machine);
  if (!has_axis_word(r.sorted)) return;
  if (dwell != nullptr && r.dialect.dwell_takes_axis_words) return;
  if (dwell != nullptr) fail(*dwell, "axis words stand beside a dwell");
  if (smooth != nullptr) fail(*smooth, fmt::format("axis words stand beside G{}", smooth->word->value));
  add_move(block, r);
}

/// What a block that may be skipped has set is in doubt afterwards.
void doubt_skippable(const Block& block, Reading& r, const ModalState& before) {
  ModalState& now = r.state;
  const auto fail = [&](const char* what) {
    refuse(r.program.file, block, block.block_delete.begin,
           fmt::format("a block that '/' may skip sets the {}: what follows would be in doubt", what));
  };
  if (now.unit != before.unit) fail("unit");
  if (now.work_offset != before.work_offset) fail("work offset");
  if (now.motion != before.motion) now.motion = MotionMode::doubtful;
  if (now.tool_length != before.tool_length) now.tool_length.reset(), now.known[2] = false;
  now.exact_stop = now.exact_stop || before.exact_stop;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (r.sorted.word(axis_letters[axis]) != nullptr) now.known[axis] = false;
}

void check_program_number(const Block& block, const Reading& r) {
  const Word* o = r.sorted.word('O');
  if (o == nullptr) return;
  if (block.words.size() > 1 || r.program.block_count > 1)
    refuse(r.program.file, block, o->span.begin,
           fmt::format("O{}: subprograms are not read yet; a program's number stands alone and first",
                       o->value));
}

void apply_words(const Block& block, Reading& r) {
  sort_words(r.program.file, r.dialect, block, r.sorted);
  check_program_number(block, r);
  apply_feed_and_spindle(r);
  apply_tool_change(r);
  apply_work_offset(r);
  apply_tool_length(block, r);
  apply_path_mode(block, r);
  apply_motion_mode(r);
  remark_machine_codes(block, r);
  apply_axis_words(block, r);
}

}  // namespace

void interpret(const Block& block, Reading& r) {
  apply_comments(block, r);
  remark_length(block, r);
  if (block.words.empty()) return;
  ++r.program.block_count;
  if (empty(block.block_delete)) {
    apply_words(block, r);
    r.ended = r.sorted.has(MAction::end);
  } else {
    const ModalState before = r.state;
    apply_words(block, r);
    doubt_skippable(block, r, before);
  }
}

}  // namespace counterflex
