#include "counterflex/program/restart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "counterflex/files/text.hpp"
#include "program/restart_effects.hpp"

namespace counterflex {
using namespace restart;

namespace {

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
