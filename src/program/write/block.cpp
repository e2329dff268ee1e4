#include "program/write/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "counterflex/program/kept_words.hpp"
#include "program/text/integer_words.hpp"
#include "program/text/number_style.hpp"
#include "program/write/numbers.hpp"
#include "program/write/words.hpp"

namespace counterflex {
namespace {

/// A point of an edit, in an inserted block or in the block itself.
struct Stop {
  Via via;
  int motion;
};

/// The points of an edit in order, and the point to which the block itself moves.
struct Plan {
  std::vector<Stop> stops;
  std::size_t own = 0;
};

/// The block's own point of an edit with `stops` points.
std::size_t own_stop(const Original& o, std::size_t stops) {
  const bool first = stops > 1 && !o.block.corner && is_first_piece(o.move, kept_words(o.program, o.move));
  return first ? 0 : stops - 1;
}

Plan plan(const Original& o, const MoveEdit& edit, int motion) {
  Plan plan;
  if (edit.jump) plan.stops.push_back({*edit.jump, 1});
  for (const Via& via : edit.inserted) plan.stops.push_back({via, motion});
  plan.stops.push_back({{edit.end_mm, edit.centre_mm, edit.orientation}, motion});
  plan.own = own_stop(o, plan.stops.size());
  return plan;
}

/// A step of the text, and whether it is the block's own.
struct PlannedStep {
  Step step;
  bool own;
  std::optional<PieceFeed> feed{};
};

/// The steps to write. A point that equals the position in the text gets no block.
std::vector<PlannedStep> round_steps(const Original& o, const Plan& plan, TextPosition position,
                                     const WriteOptions& options) {
  std::vector<PlannedStep> steps;
  for (std::size_t i = 0; i < plan.stops.size(); ++i) {
    const bool own = i == plan.own, end = i + 1 == plan.stops.size();
    const Place place = end ? Place::end : own ? Place::own_inside : Place::inside;
    const Step step = round_step(o.move, position, plan.stops[i].via, plan.stops[i].motion, place, options);
    position = step.after;
    if (own || !equals_text_position(step)) steps.push_back({step, own});
  }
  return steps;
}

/// A last turn without a way is not shorter: ten digits of an angle.
constexpr double shortest_turn_deg = short_turn_deg / 20;

/// Digits for which the time of a piece is exact to a millionth.
int feed_decimals(double feed) {
  return feed > 0 ? std::clamp(6 - static_cast<int>(std::floor(std::log10(feed))), 1, 9) : 1;
}

double way_mm(const Step& step) {
  return length(curve_of_step(step));
}

double step_turn_deg(const Move& move, const Step& step) {
  if (!move.orientation || !move.orientation->by_angles || !step.before.orientation) return 0;
  return turned_deg(*step.before.orientation, *step.after.orientation);
}

/// G93: the pieces of a block share its time by their ways and turns, which both grow evenly in the original.
void share_time(const Move& move, std::vector<PlannedStep>& steps) {
  if (move.feed_mode != FeedMode::inverse_time || move.feed_per_min <= 0 || steps.size() < 2) return;
  const auto share_of = [&](const PlannedStep& piece) {
    return std::hypot(way_mm(piece.step), step_turn_deg(move, piece.step));
  };
  double whole = 0;
  for (const PlannedStep& piece : steps) whole += share_of(piece);
  for (PlannedStep& piece : steps) {
    if (const double part = share_of(piece); part > 0) {
      const double feed = move.feed_per_min * whole / part;
      piece.feed = {feed, feed_decimals(feed)};
    }
  }
}

/// Whether the step goes along X, Y or Z, and F along these leaves it less time than its turn takes.
bool turns_on_the_way(const Move& move, const PlannedStep& piece) {
  const double way = way_mm(piece.step) / mm_per(move.unit), turn = step_turn_deg(move, piece.step);
  return way > 0 && way < turn && turn > short_turn_deg;
}

/// The end of a block that only turns the tool is reached by a turn without a way: there F is that of the
/// block, and stays it for the blocks behind. The way ends before that turn: it is so short that the way is
/// early by half a digit at most, as far as the digits of angles allow.
void add_last_turn(const Original& o, const MoveEdit& edit, const Step& last, const WriteOptions& options,
                   Plan& plan) {
  const OrientationNumbers& start = *last.before.orientation;
  OrientationNumbers numbers = edit.orientation ? *edit.orientation : o.move.orientation->end;
  const double turn = turned_deg(start, numbers),
               digit_mm = mm_per(o.move.unit) * std::pow(10.0, -decimals_of(o.move, options).inserted),
               share = std::clamp(digit_mm / 2 / way_mm(last), shortest_turn_deg / turn,
                                  short_turn_deg / 2 / turn);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] -= share * (numbers[i] - start[i]);
  plan.stops.insert(plan.stops.end() - 1, {{edit.end_mm, {}, numbers}, plan.stops.back().motion});
  plan.own = own_stop(o, plan.stops.size());
}

[[noreturn]] void refuse_turn(const Original& o) {
  refuse(o.program.file, o.block, o.block.span.begin,
         fmt::format(
             "this block turns the tool by {:.4g} degrees and does not move X, Y and Z. Its correction "
             "moves them, and then F is the feed along them. Divided blocks that keep the time need G94, "
             "F as a number in the block or before it, no '/', no exact stop and no code that acts at "
             "the end. Otherwise program the block under G93 or as a rapid",
             turned_deg(o.move)));
}

/// G94: pieces of a block that only turns the tool get the F that keeps their time.
void keep_time_of_turn(const Original& o, const MoveEdit& edit, const TextPosition& before,
                       const WriteOptions& options, Plan& plan, std::vector<PlannedStep>& steps) {
  const auto may_hurry = [&](const PlannedStep& piece) { return turns_on_the_way(o.move, piece); };
  if (o.move.feed_mode != FeedMode::length || !only_turns(o.move) || std::ranges::none_of(steps, may_hurry))
    return;
  const Word* word = find_word(o.block, 'F');
  const bool knows_feed = o.move.feed_mm_min > 0 && (word == nullptr || word->literal);
  if (!o.move.may_split || o.move.block_delete || !knows_feed) refuse_turn(o);
  if (may_hurry(steps.back())) {
    add_last_turn(o, edit, steps.back().step, options, plan);
    steps = round_steps(o, plan, before, options);
  }
  const double deg_per_min = o.move.feed_mm_min / mm_per(o.move.unit);
  constexpr int all_decimals = 9;
  int decimals = 0;
  while (decimals < all_decimals && rounded(deg_per_min, decimals) != rounded(deg_per_min, all_decimals))
    ++decimals;
  const PieceFeed same{rounded(deg_per_min, decimals), decimals};
  bool changed = false;  // whether F of the piece before acts
  for (PlannedStep& piece : steps) {
    const bool hurries = may_hurry(piece);
    if (hurries) {
      const double minutes = step_turn_deg(o.move, piece.step) / deg_per_min,
                   feed = way_mm(piece.step) / mm_per(o.move.unit) / minutes;
      piece.feed = {feed, feed_decimals(feed)};
    } else if (changed && word == nullptr) {
      piece.feed = same;
    }
    changed = hurries;
  }
}

bool is_length(const Word& word, const Original& o) {
  const bool counts = word.letter == 'K' && o.move.cycle && o.dialect.k_repeats_holes &&
                      find_word(o.block, 'I') == nullptr && find_word(o.block, 'J') == nullptr;
  return is_axis(word) || ((o.move.arc || o.move.cycle) && is_centre(word) && !counts);
}

void check_integer_words(const Original& o) {
  if (!integers_may_be_ambiguous(o.program, o.dialect)) return;
  for (const Word& word : o.block.words)
    if (is_length(word, o) && word.literal && !word.point && word.value != 0)
      refuse(o.program.file, o.block, word.span.begin,
             integer_question(fmt::format("{}{}", word.letter, word.value)));
}

/// The modal motion between the pieces of a block.
struct ModalMotion {
  int own = 0;                 ///< that of the block in the original
  bool relies = false;         ///< the block has no motion word
  std::optional<int> written;  ///< motion of the text before the next piece
};

ModalMotion modal_motion(const Original& o, std::optional<int> restate) {
  const auto& words = o.block.words;
  ModalMotion modal{motion_of(o.move), false, {}};
  modal.relies = !o.move.cycle && std::none_of(words.begin(), words.end(),
                                               [&](auto& w) { return is_motion_word(w, o.dialect); });
  if (modal.relies && restate) modal.own = *restate;
  if (!restate) modal.written = modal.own;
  return modal;
}

/// Whether a piece with `motion` needs a motion word, beyond what its kind requires.
bool must_state(int motion, ModalMotion& modal) {
  const bool must = modal.relies && modal.written != motion;
  modal.written = motion;
  return must;
}

/// The motion that later blocks without a motion word must state, given the value before this block.
std::optional<int> restated_after(const Move& move, std::optional<int> before, const ModalMotion& modal) {
  if (!move.cycle && modal.written != modal.own) return modal.own;
  return move.block_delete ? before : std::nullopt;
}

/// The N of each piece of a split block. The first piece has the block's own.
class PieceNumbers {
 public:
  PieceNumbers(const Original& o, std::size_t pieces, const WriteOptions& options, Rewritten& out) : o_(o) {
    word_ = find_word(o.block, 'N');
    if (word_ == nullptr || pieces < 2 || options.number_pieces == nullptr) return;
    const bool counts = word_->literal && !word_->point && word_->value >= 0;
    numbered_ = counts && options.number_pieces->has_room_after(count_of(*word_), pieces - 1);
    if (numbered_) return;
    if (out.unnumbered_pieces == 0) out.first_unnumbered_line = o.move.line;
    out.unnumbered_pieces += pieces - 1;
  }

  std::string of(std::size_t piece) const {
    if (word_ == nullptr || (piece > 0 && !numbered_)) return {};
    if (piece == 0) return std::string(o_.text(word_->span));
    return fmt::format("{}{:0{}}", o_.text({word_->span.begin, word_->number.begin}),
                       count_of(*word_) + static_cast<long>(piece), word_->number.end - word_->number.begin);
  }

 private:
  const Original& o_;
  const Word* word_ = nullptr;
  bool numbered_ = false;
};

std::string text_of(const Original& o, const std::vector<PlannedStep>& steps, const CycleWords& cycle,
                    double call_shift_mm, const WriteOptions& options, ModalMotion& modal, Rewritten& out) {
  const PieceNumbers numbers(o, steps.size(), options, out);
  std::string text;
  bool own_is_written = false;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PlannedStep& piece = steps[i];
    const BesidesPoint besides{must_state(piece.step.motion, modal), piece.feed, cycle, call_shift_mm,
                               steps.size() > 1 ? std::optional(numbers.of(i)) : std::nullopt};
    if (piece.own) {
      text += own_block(o, piece.step, besides, out);
    } else {
      const std::string line = inserted_block(o, piece.step, besides);
      text += own_is_written ? o.line_end + line : line + o.line_end;
      ++out.inserted_blocks;
    }
    own_is_written = own_is_written || piece.own;
  }
  return text;
}

/// Writes the block without lexing it again if only numbers change; then updates `state`.
bool changes_numbers_only(const Program& program, const MoveEdit& edit, const TextPosition& before,
                          const CycleWords& cycle, const WriteOptions& options, TextState& state,
                          Rewritten& out) {
  const Move& move = program.moves[edit.move];
  if (edit.jump || !edit.inserted.empty() || state.restate_motion || move.called || move.angle_axis != 0 ||
      move.orientation)
    return false;
  const int motion = motion_of(move);
  const Step step = round_step(move, before, {edit.end_mm, edit.centre_mm}, motion, Place::end, options);
  if (step.motion != motion) return false;
  std::size_t line_limit = 0;
  if (writes_words(step) || cycle.bottom.write || cycle.retract.write) {
    const Dialect& dialect = *find_dialect(program.dialect);
    if (integers_may_be_ambiguous(program, dialect)) return false;
    line_limit = dialect.line_limit;
  }
  if (!append_with_numbers(program, move, step, cycle, line_limit, out)) return false;
  assign(state.position, step.after);
  forget_skippable(move, before, state.position);
  return true;
}

/// Shift of the heights of the cycle called at `move`, as they are written.
double height_shift(const Move& move, const Step& step) {
  return step.axes[2].position_mm.value_or(move.end_mm.z()) - move.end_mm.z();
}

/// A block that calls a subprogram or macro: its words are arguments.
bool is_call(const Block& block) {
  return !empty(block.flow_keyword) || block.statement == Statement::cycle ||
         std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
           return word.letter == 'O' || (word.letter == 'M' && word.value >= 97 && word.value <= 99) ||
                  (word.letter == 'G' && word.value >= 65 && word.value < 68);
         });
}

}  // namespace

void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, TextState& state, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split || move.may_position || changes_height_inside(move));
  assert(!edit.jump || move.may_jump);
  const TextPosition before = known_text_position(move, state.position);
  CycleWords cycle;
  if (move.cycle) cycle = round_cycle(move, before[2], edit.bottom_mm, edit.retract_mm, state.cycle, options);
  if (changes_numbers_only(program, edit, before, cycle, options, state, out)) return;
  const Original o = lex_again(program, move, style);
  ModalMotion modal = modal_motion(o, state.restate_motion);
  Plan points = plan(o, edit, modal.own);
  std::vector<PlannedStep> steps = round_steps(o, points, before, options);
  share_time(move, steps);
  keep_time_of_turn(o, edit, before, options, points, steps);
  const double call_shift_mm = move.called ? height_shift(move, steps.back().step) : 0;
  std::string text = text_of(o, steps, cycle, call_shift_mm, options, modal, out);
  if (move.called && !has_call(move, call_shift_mm, state)) {
    text.insert(0, restated_call(move, call_shift_mm) + o.line_end);
    ++out.changed_words;
    state.call = {move.called->line, call_shift_mm};
  }
  if (text != o.text(o.block.span)) check_integer_words(o);
  state.position = steps.back().step.after;
  forget_skippable(move, before, state.position);
  state.restate_motion = restated_after(move, state.restate_motion, modal);
  out.text += text;
}

bool has_call(const Move& move, double shift_mm, const TextState& state) {
  if (!move.called || move.called->modal.empty()) return true;
  return shift_mm == (state.call.line == move.called->line ? state.call.shift_mm : 0);
}

void keep_block(const Move& move, TextState& state) {
  if (move.cycle) keep_cycle(*move.cycle, state.cycle);
  state.position = text_position_after_original(move, state.position);
}

void copy_block(const Program& program, const ProgramStyle& style, const Move& move, TextState& state,
                Rewritten& out) {
  keep_block(move, state);
  const Original o = lex_again(program, move, style);
  if (is_call(o.block)) {
    out.text += o.text(move.block);
    return;
  }
  ModalMotion modal = modal_motion(o, state.restate_motion);
  Step unchanged;
  unchanged.motion = modal.own;
  out.text += own_block(o, unchanged, {must_state(modal.own, modal)}, out);
  state.restate_motion = restated_after(move, state.restate_motion, modal);
}

bool ends_motion(const Block& block, const Dialect& dialect) {
  const bool ends_program =
      block.percent || !empty(block.flow_keyword) || is_program_number(block) ||
      std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
        return word.letter == 'M' && (word.value == 2 || word.value == 30 || word.value == 99);
      });
  const bool has_motion = std::any_of(block.words.begin(), block.words.end(),
                                      [&](auto& w) { return is_motion_word(w, dialect); });
  return ends_program || (has_motion && empty(block.block_delete));
}

}  // namespace counterflex
