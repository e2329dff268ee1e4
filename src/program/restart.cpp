#include "counterflex/program/restart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/gcode/words/codes.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// States that a program sets, and axes whose positions it gives. Axes come last.
enum Item : std::uint8_t {
  of_unit,
  of_distance,
  of_plane,
  of_offset,
  of_cutter,
  of_path,
  of_centres,
  of_motion,
  of_feed_mode,
  of_spindle_mode,
  of_tool_length,
  of_retract,
  of_feed,
  of_speed,
  of_spindle,
  of_mist,
  of_flood,
  of_axis
};

constexpr std::string_view axes = "XYZABCUVW";
constexpr std::size_t items = of_axis + axes.size();

/// A word that sets a state, and its line.
struct Given {
  std::string word;
  int line = 0;
};

using States = std::array<std::optional<Given>, items>;

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

/// What a block sets and does.
struct Effects {
  States set{};
  std::map<int, std::string> codes{};  ///< states without a group, by number
  std::string carries{};               ///< the word whose effect on later blocks is not followed
  std::string why_none{};              ///< why no line of the program is proven
  std::array<bool, axes.size()> positions{};
  std::optional<long> tool{};
  bool changes_tool = false, only_chooses = true, ends = false;
  bool has_data = false;                      ///< words of axes are not positions
  bool has_axis = false, has_centre = false;  ///< words of axes, of arcs
  bool is_machine = false;                    ///< they are positions of the machine
  bool cuts_by_itself = false;                ///< a cycle of the control
  bool has_hole = true;                       ///< the words that a drilling cycle needs
  std::optional<Action> motion{};
};

bool has_letter(const Block& block, char letter) {
  return std::ranges::any_of(block.words, [&](const Word& word) { return word.letter == letter; });
}

struct BlockText {
  std::string_view text;
  const Dialect& dialect;
};

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
                                       "RND", "CHF", "CHR", "FB", "SPOS", "MSG", "STOPRE"});
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

/// A tool change, and what the blocks behind it have set so far.
struct Candidate {
  RestartLine row;
  States before{};                  ///< what the program had set there
  std::map<int, Given> codes{};     ///< likewise
  std::array<bool, items> given{};  ///< again, or for the first time
  std::set<int> codes_given{};
  std::array<bool, items> missed{};
  std::set<int> codes_missed{};
  bool has_cut = false;

  void miss(const std::string& what) { row.missing.append(row.missing.empty() ? "" : ", ").append(what); }

  void need(Item item) {
    const std::size_t i = item;
    if (!before[i] || given[i] || missed[i]) return;
    missed[i] = true;
    miss(fmt::format("{} of line {}", before[i]->word, before[i]->line));
  }

  void need_position(std::size_t axis) {
    const std::size_t i = of_axis + axis;
    if (given[i] || missed[i]) return;
    missed[i] = true;
    miss(fmt::format("{} before the first cut", axes[axis]));
  }
};

constexpr std::array before_axis_words{of_unit,   of_distance, of_plane,   of_offset,
                                       of_cutter, of_path,     of_centres, of_motion};
constexpr std::array before_cuts{of_feed_mode, of_spindle_mode, of_tool_length,
                                 of_feed,      of_speed,        of_spindle};

}  // namespace

struct RestartScan::State {
  const Dialect* dialect = nullptr;
  RestartLines found{};
  int lines = 0;  ///< before the text
  States set{};   ///< by the program so far
  std::map<int, Given> codes{};
  std::optional<Given> carried{};
  std::optional<Action> motion{};
  bool relative = false, ended = false;
  int programs = 0;  ///< lines with an O-number
  std::optional<Candidate> open{};
  std::optional<RestartLine> chosen{};  ///< a line with T alone, or with its D, directly before this one
  bool chosen_sets_length = false;

  void close() {
    if (open && open->has_cut) found.lines.push_back(std::move(open->row));
    open.reset();
  }

  void begin(RestartLine row) {
    close();
    open.emplace();
    open->row = std::move(row);
    open->before = set;
    open->codes = codes;
    if (carried) open->miss(fmt::format("{} of line {}", carried->word, carried->line));
  }

  bool is_cut(const Effects& effects) const {
    if (effects.cuts_by_itself) return true;
    const bool moves = (effects.has_axis || effects.has_centre) && !effects.is_machine;
    return moves && motion && *motion != Action::rapid && *motion != Action::end_motion;
  }

  void check(const Effects& effects) {
    Candidate& c = *open;
    const bool cuts = is_cut(effects);
    if (effects.has_axis || effects.has_centre || cuts) {
      if (!c.has_cut) {
        for (const Item item : before_axis_words)
          if (item != of_motion || !effects.cuts_by_itself) c.need(item);
        for (const auto& [number, code] : c.codes)
          if (!c.codes_given.contains(number) && c.codes_missed.insert(number).second)
            c.miss(fmt::format("{} of line {}", code.word, code.line));
        if (effects.positions[2] && !effects.is_machine) c.need(of_tool_length);
      }
      const bool is_hole = motion == Action::cycle && cuts && !effects.cuts_by_itself;
      if (is_hole) c.need(of_retract);
      if (is_hole && !c.has_cut && !effects.has_hole) c.miss("Z and R of the cycle");
      if (is_hole) take_positions(effects, 2);  // X and Y of the hole
    }
    if (cuts && !c.has_cut) {
      for (const Item item : before_cuts) c.need(item);
      for (const Item coolant : {of_mist, of_flood})
        if (c.before[coolant] && !c.before[coolant]->word.ends_with('9')) c.need(coolant);
      for (std::size_t axis = 0; axis < axes.size(); ++axis)
        if (axis < 3 || c.before[of_axis + axis]) c.need_position(axis);
      c.has_cut = true;
    }
    take_positions(effects, axes.size());
  }

  /// Of the first `count` axes.
  void take_positions(const Effects& effects, std::size_t count) {
    if (effects.is_machine || relative) return;
    for (std::size_t axis = 0; axis < count; ++axis)
      if (effects.positions[axis]) open->given[of_axis + axis] = true;
  }

  void add(const Block& block, const BlockText& in) {
    Effects effects = effects_of(block, in);
    if (is_program_number(block) && ++programs > 1) effects.why_none = "the file has several programs";
    if (!effects.why_none.empty() && found.why_none.empty())
      found.why_none = fmt::format("{} (line {})", effects.why_none, lines + block.line);
    const bool may_skip = !empty(block.block_delete);
    const RestartLine row{lines + block.line, effects.tool.value_or(0),
                          without_controls(part(in.text, block.span)), ""};
    if (effects.changes_tool && !may_skip) {
      if (effects.tool)
        begin(row);
      else if (chosen) {
        begin(*chosen);
        open->given[of_tool_length] = chosen_sets_length;
      } else
        close();
    }
    chosen.reset();
    if (effects.tool && effects.only_chooses && !may_skip) {
      chosen = row;
      chosen_sets_length = effects.set[of_tool_length].has_value();
    }
    if (open && !open->has_cut && !effects.carries.empty())
      open->miss(fmt::format("{} of line {}", effects.carries, lines + block.line));
    take(effects, lines + block.line, may_skip);
    if (open) check(effects);
    ended = effects.ends && !may_skip;
  }

  void take(const Effects& effects, int line, bool may_skip) {
    for (std::size_t i = 0; i < items; ++i) {
      if (!effects.set[i]) continue;
      set[i] = Given{effects.set[i]->word, line};
      if (open && !may_skip) open->given[i] = true;
    }
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
      if (effects.positions[axis]) set[of_axis + axis] = Given{std::string(1, axes[axis]), line};
    for (const auto& [number, word] : effects.codes) {
      codes[number] = Given{word, line};
      if (open && !may_skip) open->codes_given.insert(number);
    }
    if (!effects.carries.empty() && !carried) carried = Given{effects.carries, line};
    if (effects.motion) motion = effects.motion;
    if (const auto& distance = effects.set[of_distance])
      relative = distance->word.find("91") != std::string::npos;
  }
};

RestartScan::RestartScan(const std::string& dialect) : state_(new State) {
  const Dialect* found = find_dialect(dialect);
  if (found != nullptr && found->language.empty() && found->name != klartext_name)
    state_->dialect = found;
  else
    state_->found.why_none = "its language is not G-code";
}

RestartScan::~RestartScan() = default;
RestartScan::RestartScan(RestartScan&&) noexcept = default;

void RestartScan::add(std::string_view text) {
  State& s = *state_;
  if (s.dialect == nullptr) return;
  Block block;
  while (!s.ended && s.found.why_none.empty() && next_line(text, block)) {
    lex(text, "", *s.dialect, block);
    if (has_content(block)) s.add(block, {text, *s.dialect});
  }
  s.lines += static_cast<int>(std::ranges::count(text, '\n'));
}

RestartLines RestartScan::finish() {
  State& s = *state_;
  s.close();
  if (!s.found.why_none.empty()) s.found.lines.clear();
  return std::move(s.found);
}

}  // namespace counterflex
