#include "program/restart_effects.hpp"

#include <algorithm>
#include <cmath>

#include "program/text/scanner.hpp"

namespace counterflex::restart {
namespace {

std::optional<Item> item_of(CodeGroup group) {
  switch (group) {
    case CodeGroup::motion:
      return of_motion;
    case CodeGroup::distance:
      return of_distance;
    case CodeGroup::unit:
      return of_unit;
    case CodeGroup::feed_mode:
      return of_feed_mode;
    case CodeGroup::plane:
      return of_plane;
    case CodeGroup::offset:
      return of_offset;
    case CodeGroup::tool_length:
      return of_tool_length;
    case CodeGroup::cutter:
      return of_cutter;
    case CodeGroup::path:
      return of_path;
    case CodeGroup::arc:
      return of_centres;
    case CodeGroup::retract:
      return of_retract;
    case CodeGroup::spindle:
      return of_spindle_mode;
    case CodeGroup::none:
      break;
  }
  return std::nullopt;
}

bool has_letter(const Block& block, char letter) {
  return std::ranges::any_of(block.words, [&](const Word& word) { return word.letter == letter; });
}

void add_statement(const Block& block, Effects& effects) {
  switch (block.statement) {
    case Statement::none:
      return;
    case Statement::end:
      effects.ends = true;
      return;
    case Statement::call:
      effects.why_none = "it calls a subprogram or a cycle";
      return;
    case Statement::cycle:
    case Statement::curve:
      effects.cuts_by_itself = true;
      return;
    default:
      effects.carries = "a statement";
  }
}

void add_g(const Block& block, const BlockText& in, const Word& word, Effects& effects) {
  const int tenths = static_cast<int>(std::lround(word.value * 10));
  const GCode* code = find_g_code(tenths, in.dialect);
  const std::string name(part(in.text, word.span));
  if (code == nullptr) return void(effects.carries = name);
  const bool linux_like = (in.dialect.family & (linuxcnc_family | grbl_family)) != 0;
  switch (code->action) {
    case Action::displace:
    case Action::shift:
    case Action::set_data:
    case Action::not_read:
      effects.carries = name;
      effects.has_data = code->group == CodeGroup::none;
      return;
    case Action::limits:
      effects.carries = name;
      effects.has_data = true;
      return;
    case Action::own_way:
      effects.carries = name;
      effects.cuts_by_itself = true;
      return;
    case Action::pocket:
    case Action::engrave:
      effects.cuts_by_itself = true;
      return;
    case Action::call:
      effects.why_none = "it calls a macro";
      return;
    case Action::machine_move:
    case Action::reference_move:
      effects.is_machine = true;
      return;
    case Action::end_motion:
      effects.motion = Action::end_motion;
      return;
    case Action::tool_length:  // G43 takes the modal H of a control that has one
      if (!linux_like && !has_letter(block, 'H')) return;
      break;
    case Action::cutter:
      if (!linux_like && !has_letter(block, 'D')) return;
      break;
    case Action::cycle:
      effects.has_hole = has_letter(block, 'Z') && has_letter(block, 'R');
      break;
    default:
      break;
  }
  const std::optional<Item> item = item_of(code->group);
  if (item == of_motion) effects.motion = code->action;
  if (item)
    effects.set[*item] = Given{name, 0};
  else if (code->action == Action::state || code->action == Action::spindle_speed ||
           code->action == Action::smooth)
    effects.codes[tenths] = name;
}

void add_m(const BlockText& in, const Word& word, Effects& effects) {
  const int code = static_cast<int>(std::lround(word.value));
  const std::string name(part(in.text, word.span));
  switch (action_of_m(code, in.dialect)) {
    case MAction::tool_change:
      effects.changes_tool = true;
      return;
    case MAction::end:
      effects.ends = true;
      return;
    case MAction::call:
    case MAction::return_from_call:
      effects.why_none = "it has subprograms";
      return;
    case MAction::retract:
      return;
    case MAction::restore:
    case MAction::kinematics:
    case MAction::machine:
      effects.carries = name;
      return;
    case MAction::state:
    case MAction::acts_after:
      break;
  }
  if (code >= 3 && code <= 5)
    effects.set[of_spindle] = Given{name, 0};
  else if (code >= 7 && code <= 9) {
    if (code != 8) effects.set[of_mist] = Given{name, 0};
    if (code != 7) effects.set[of_flood] = Given{name, 0};
  } else if (code != 0 && code != 1 && code != 19 && code != 48 && code != 60)
    effects.carries = name;
}

void add_word(const Block& block, const BlockText& in, const Word& word, Effects& effects) {
  const std::string name(part(in.text, word.span));
  const bool chooses =
      word.letter == 'T' || word.letter == 'N' || (word.letter == 'D' && in.dialect.family == siemens_family);
  if (!chooses) effects.only_chooses = false;
  if (const std::size_t axis = axes.find(word.letter); axis != std::string_view::npos)
    effects.has_axis = effects.positions[axis] = true;
  switch (word.letter) {
    case 'G':
      return add_g(block, in, word, effects);
    case 'M':
      return add_m(in, word, effects);
    case 'T':
      effects.tool = count_of(word);
      return;
    case 'F':
      effects.set[of_feed] = Given{name, 0};
      return;
    case 'S':
      effects.set[of_speed] = Given{name, 0};
      return;
    case 'I':
    case 'J':
    case 'K':
    case 'R':
      effects.has_centre = true;
      return;
    case 'D':
      if (in.dialect.family == siemens_family) effects.set[of_tool_length] = Given{name, 0};
      return;
    default:
      return;
  }
}

/// The first name in a block of a Sinumerik (OVR, FGROUP, SOFT) that is not one of its own motion or text.
std::string unfollowed_name(std::string_view text) {
  constexpr auto of_block =
      std::to_array<std::string_view>({"AC", "IC", "DC", "ACP", "ACN", "CR", "AR", "AP", "RP", "TURN", "ANG",
                                       "RND", "CHF", "CHR", "FB", "SPOS", "SUPA", "MSG", "STOPRE"});
  bool quoted = false;
  for (std::size_t at = 0; at < text.size() && (quoted || text[at] != ';'); ++at) {
    if (text[at] == '"') quoted = !quoted;
    if (quoted || !is_letter(text[at])) continue;
    std::string name;
    for (; at < text.size() && (is_letter(text[at]) || is_digit(text[at]) || text[at] == '_'); ++at)
      name += upper(text[at]);
    --at;
    const bool is_address = name.size() < 2 || !is_letter(name[1]);
    if (!is_address && std::ranges::find(of_block, name) == of_block.end()) return name;
  }
  return {};
}

}  // namespace

Effects effects_of(const Block& block, const BlockText& in) {
  Effects effects;
  if (in.dialect.family == siemens_family && block.statement == Statement::none)
    effects.carries = unfollowed_name(part(in.text, block.span));
  add_statement(block, effects);
  if (!empty(block.flow_keyword)) effects.why_none = "it has subprograms, loops, conditions or jumps";
  const bool literal = std::ranges::all_of(block.words, [](const Word& word) { return word.literal; });
  if (block.assigns || block.assigns_by_name || block.angle || !literal)
    effects.why_none = "it has variables or expressions";
  for (const Word& word : block.words) add_word(block, in, word, effects);
  const bool dwells =
      std::ranges::any_of(block.words, [](const Word& w) { return w.letter == 'G' && w.value == 4; });
  if (dwells || effects.has_data) {
    effects.has_axis = effects.has_centre = false;
    effects.positions = {};
  }
  if (dwells) {
    effects.set[of_feed].reset();  // F and S of a dwell are times
    effects.set[of_speed].reset();
  }
  return effects;
}

}  // namespace counterflex::restart
