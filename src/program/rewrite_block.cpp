#include "program/rewrite_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "program/rewrite_words.hpp"

namespace counterflex {
namespace {

/// A point of an edit, in an inserted block or in the block itself.
struct Stop {
  Via via;
  int motion;
};

/// The points of an edit in order, and which of them the block itself moves to.
struct Plan {
  std::vector<Stop> stops;
  std::size_t own = 0;
};

Plan plan(const Original& o, const MoveEdit& edit) {
  const int motion = motion_of(o.move);
  Plan plan;
  if (edit.jump_mm) plan.stops.push_back({{*edit.jump_mm}, 1});
  for (const Via& via : edit.inserted) plan.stops.push_back({via, motion});
  plan.stops.push_back({{edit.end_mm, edit.centre_mm}, motion});
  const bool first = o.acts_itself && o.move.motion == Motion::feed;
  plan.own = first ? 0 : plan.stops.size() - 1;
  return plan;
}

/// A step of the text, and whether it is the block's own.
struct PlannedStep {
  Step step;
  bool own;
  std::optional<double> feed_per_min{};
};

/// The steps that are written: a point that the text holds already gets no block.
std::vector<PlannedStep> settle_steps(const Original& o, const Plan& plan, HeldPosition held,
                                      const WriteOptions& options) {
  std::vector<PlannedStep> steps;
  for (std::size_t i = 0; i < plan.stops.size(); ++i) {
    const bool own = i == plan.own, end = i + 1 == plan.stops.size();
    const Place place = end ? Place::end : own ? Place::own_inside : Place::inside;
    const Step step = settle_step(o.move, held, plan.stops[i].via, plan.stops[i].motion, place, options);
    held = step.after;
    if (own || !is_there(step)) steps.push_back({step, own});
  }
  return steps;
}

/// G93: the time of the block is shared by its pieces as their lengths are.
void share_time(const Move& move, std::vector<PlannedStep>& steps) {
  if (move.feed_mode != FeedMode::inverse_time || move.feed_per_min <= 0 || steps.size() < 2) return;
  double whole = 0;
  for (const PlannedStep& piece : steps) whole += length(curve_of_step(piece.step));
  for (PlannedStep& piece : steps)
    if (const double part = length(curve_of_step(piece.step)); part > 0)
      piece.feed_per_min = move.feed_per_min * whole / part;
}

bool is_length(const Word& word, const Move& move) {
  return is_axis(word) || ((move.arc || move.cycle) && is_centre(word));
}

void check_integer_words(const Original& o) {
  if (!o.dialect.integer_words_doubtful || o.program.integer_words != IntegerWords::unsaid) return;
  for (const Word& word : o.block.words)
    if (is_length(word, o.move) && !word.point && word.value != 0)
      refuse(o.program.file, o.block, word.span.begin,
             fmt::format(
                 "{}{} has no point, and the block must be rewritten: it may mean units or increments; say "
                 "which with --integer-words units|increments",
                 word.letter, word.value));
}

/// The motion that is modal between the pieces of one block.
class ModalMotion {
 public:
  ModalMotion(const Original& o, bool restate)
      : relies_(!o.move.cycle && std::none_of(o.block.words.begin(), o.block.words.end(),
                                              [&](auto& w) { return says_motion(w, o.dialect); })) {
    if (!restate) modal_ = motion_of(o.move);
  }

  /// Whether a block that moves under `motion` must say so, where its own kind does not anyway.
  bool must_state(int motion) {
    const bool must = relies_ && modal_ != motion;
    modal_ = motion;
    return must;
  }

 private:
  bool relies_;
  std::optional<int> modal_;
};

std::string text_of(const Original& o, const std::vector<PlannedStep>& steps, const CycleWords& cycle,
                    bool restate, Rewritten& out) {
  ModalMotion modal(o, restate);
  std::string text;
  bool own_is_past = false;
  for (const PlannedStep& piece : steps) {
    const BesidesPoint besides{modal.must_state(piece.step.motion), piece.feed_per_min, cycle};
    if (piece.own) {
      text += own_block(o, piece.step, besides, out);
    } else {
      const std::string line = inserted_block(o, piece.step, besides);
      text += own_is_past ? o.line_end + line : line + o.line_end;
      ++out.inserted_blocks;
    }
    own_is_past = own_is_past || piece.own;
  }
  return text;
}

/// A block that calls a subprogram or macro: its words are arguments.
bool is_call(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
    return word.letter == 'O' || (word.letter == 'M' && word.value >= 97 && word.value <= 99) ||
           (word.letter == 'G' && word.value >= 65 && word.value < 68);
  });
}

/// Whether what follows a block must say its motion, given whether it had to before.
bool restates_after(const Move& move, bool before, int last_motion) {
  if (move.cycle) return before && move.block_delete;
  return last_motion != motion_of(move) || (before && move.block_delete);
}

}  // namespace

void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, TextState& state, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split);
  assert(!edit.jump_mm || move.may_jump);
  const Original o = lex_again(program, move, style);
  const HeldPosition before = held_at_start(move, state.held);
  std::vector<PlannedStep> steps = settle_steps(o, plan(o, edit), before, options);
  share_time(move, steps);
  CycleWords cycle;
  if (move.cycle)
    cycle = settle_cycle(move, before[2], edit.bottom_mm, edit.retract_mm, state.cycle, options);
  const std::string text = text_of(o, steps, cycle, state.restate_motion, out);
  if (text != o.text(o.block.span)) check_integer_words(o);
  state.held = steps.back().step.after;
  doubt_skippable(move, before, state.held);
  state.restate_motion = restates_after(move, state.restate_motion, steps.back().step.motion);
  out.text += text;
}

void pass_block(const Move& move, TextState& state) {
  if (move.cycle) settle_cycle(move, held_at_start(move, state.held)[2], {}, {}, state.cycle, {});
  state.held = held_after_original(move, state.held);
}

void copy_block(const Program& program, const ProgramStyle& style, const Move& move, TextState& state,
                Rewritten& out) {
  pass_block(move, state);
  const Original o = lex_again(program, move, style);
  if (is_call(o.block)) {
    out.text += o.text(move.block);
    return;
  }
  Step as_it_stands;
  as_it_stands.motion = motion_of(move);
  ModalMotion modal(o, state.restate_motion);
  const BesidesPoint besides{modal.must_state(as_it_stands.motion)};
  out.text += own_block(o, as_it_stands, besides, out);
  state.restate_motion = restates_after(move, state.restate_motion, as_it_stands.motion);
}

bool sets_motion(const Block& block, const Dialect& dialect) {
  return empty(block.block_delete) && std::any_of(block.words.begin(), block.words.end(),
                                                  [&](auto& w) { return says_motion(w, dialect); });
}

}  // namespace counterflex
