#include "program/robot/yaskawa/renumber.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "program/robot/writer.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto letters = std::to_array<std::string_view>({"C", "BC", "EC"});
using Key = std::pair<JbiFamily, std::uint32_t>;

/// The family of the positions of steps that take the place of `family`: C of P.
JbiFamily step_family(JbiFamily family) {
  const auto index = static_cast<std::size_t>(family);
  return static_cast<JbiFamily>(index % jbi_step_families);
}

/// How the positions of a family are written and counted.
struct Family {
  std::size_t digits = 5;  ///< of its first position
  std::uint32_t next = 0;  ///< number of the next position
  bool in_order = true;    ///< the numbers follow the order of the text without gaps
  std::size_t count = 0;   ///< of positions before
  std::size_t added = 0;
};

struct Renumbering {
  const std::string& text;
  JbiJob job;
  std::array<Family, jbi_step_families> families{};
  std::map<Key, std::vector<const JbiNewPosition*>> before{};  ///< the new positions, by their origin
  std::map<Key, std::string> values{};                         ///< new values of positions in their places
  std::map<Key, std::uint32_t> kept{};     ///< numbers of positions that steps moved back to
  std::map<Key, std::uint32_t> numbers{};  ///< new numbers, by family and old number
  std::vector<TextChange> changes{};

  Family& family(JbiFamily f) { return families[static_cast<std::size_t>(step_family(f))]; }
};

void count_families(Renumbering& r) {
  std::array<std::uint32_t, jbi_step_families> highest{};
  for (const JbiPosition& position : r.job.positions.list) {
    if (is_variable(position.family)) continue;
    Family& family = r.family(position.family);
    if (family.count == 0) {
      const auto values = jbi_values(r.text, position.line_begin);
      family.digits = values->name.digits.end - values->name.digits.begin;
      family.next = position.number;
    }
    family.in_order = family.in_order && position.number == family.next + family.count;
    ++family.count;
    std::uint32_t& most = highest[static_cast<std::size_t>(position.family)];
    most = std::max(most, position.number + 1);
  }
  for (std::size_t i = 0; i < jbi_step_families; ++i)
    if (!r.families[i].in_order) r.families[i].next = highest[i];
}

/// If no step uses a position any more, the first step that left it keeps it, and those with the same values.
void keep_used_positions(const std::vector<JbiNewPosition>& added, Renumbering& r) {
  for (const JbiNewPosition& position : added) {
    const Key key{position.origin.family, position.origin.number};
    const JbiPosition* origin = r.job.positions.find(key.first, key.second);
    const bool left =
        !position.is_copy && !is_variable(key.first) && !origin->used_otherwise && origin->uses == 0;
    if (left && r.values.try_emplace(key, position.values).first->second == position.values)
      r.kept[{key.first, position.name}] = key.second;
    else
      r.before[key].push_back(&position);
  }
}

std::string name_text(Family& family, JbiFamily f, std::uint32_t number) {
  return fmt::format("{}{:0{}}", letters[static_cast<std::size_t>(step_family(f))], number, family.digits);
}

/// Adds the lines of new positions before the line of `origin`.
void add_before(Renumbering& r, const JbiPosition& origin, std::string_view line_end) {
  const auto found = r.before.find({origin.family, origin.number});
  if (found == r.before.end()) return;
  std::string lines;
  for (const JbiNewPosition* position : found->second) {
    Family& family = r.family(origin.family);
    const std::uint32_t number = family.next++;
    ++family.added;
    r.numbers[{step_family(origin.family), position->name}] = number;
    lines += name_text(family, origin.family, number) + "=" + position->values + std::string(line_end);
  }
  r.changes.push_back({{origin.line_begin, origin.line_begin}, std::move(lines)});
}

void change_position(Renumbering& r, const JbiPosition& position) {
  const Key key{position.family, position.number};
  const auto written = jbi_values(r.text, position.line_begin);
  if (!is_variable(position.family)) {
    Family& family = r.family(position.family);
    const std::uint32_t number = family.in_order ? family.next++ : position.number;
    r.numbers[key] = number;
    if (number != position.number)
      r.changes.push_back({written->name.span, name_text(family, position.family, number)});
  }
  if (const auto values = r.values.find(key); values != r.values.end())
    r.changes.push_back({written->text, values->second});
}

void change_counts(Renumbering& r) {
  const auto& counts = r.job.positions.counts;
  for (std::size_t i = 0; i < jbi_step_families && i < counts.size(); ++i)
    if (const Family& family = r.families[i]; family.added > 0)
      r.changes.push_back({counts[i], std::to_string(family.count + family.added)});
}

/// The names of positions in the instructions.
void change_names(Renumbering& r) {
  RobotLine line;
  line.line_end.end = r.job.positions.end;
  while (next_robot_line(r.text, jbi_comment, line)) {
    if (empty(line.code) || r.text[line.code.begin] == '/') continue;
    for (const JbiName& name : jbi_names(r.text, line.code)) {
      Key key{name.family, name.number};
      if (const auto kept = r.kept.find(key); kept != r.kept.end()) key.second = kept->second;
      const auto number = r.numbers.find(key);
      if (number == r.numbers.end()) continue;
      const bool is_new = r.job.positions.find(name.family, name.number) == nullptr;
      if (is_new || number->second != name.number)
        r.changes.push_back({name.span, name_text(r.family(name.family), name.family, number->second)});
    }
    if (jbi_word(part(r.text, line.code)) == "END") break;
  }
}

}  // namespace

std::uint32_t first_free_number(const JbiPositions& positions) {
  std::uint32_t free = 0;
  for (const JbiPosition& position : positions.list) free = std::max(free, position.number + 1);
  return free;
}

std::string with_new_positions(const std::string& text, const std::string& file,
                               const std::vector<JbiNewPosition>& added) {
  Renumbering r{text, jbi_job(text, file)};
  count_families(r);
  keep_used_positions(added, r);
  for (const JbiPosition& position : r.job.positions.list) {
    const RobotLine line = jbi_line_at(text, position.line_begin);
    add_before(r, position, part(text, line.line_end));
    change_position(r, position);
  }
  change_counts(r);
  change_names(r);
  return with_changes(text, {0, text.size()}, r.changes);
}

}  // namespace counterflex
