#include "program/robot/rapid/module.hpp"

#include <algorithm>

#include "program/robot/rapid/changes.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view target_type = "ROBTARGET";

/// Key of a datum of routine `routine`; 0: of the module.
std::string key(std::string_view name, std::size_t routine) {
  std::string key = rapid_word(name);
  return routine == 0 ? key : key + ' ' + std::to_string(routine);
}

}  // namespace

RapidModule::RapidModule(const RapidNames& routines, RapidNames still) : still_(std::move(still)) {
  for (const std::string& name : routines) routines_[name];
}

std::size_t RapidModule::routine_at(std::size_t at) const {
  const auto next =
      std::upper_bound(sections_.begin(), sections_.end(), at,
                       [](std::size_t position, const Section& s) { return position < s.begin; });
  return next == sections_.begin() ? 0 : std::prev(next)->routine;
}

/// Key of the datum that a statement at byte `at` names: of its routine, else of the module.
std::string RapidModule::key_of(std::string_view name, std::size_t at) const {
  std::string local = key(name, routine_at(at));
  return data_.contains(local) ? local : key(name, 0);
}

const RapidDatum* RapidModule::find(std::string_view name, std::size_t at) const {
  const auto found = data_.find(key_of(name, at));
  return found != data_.end() ? &found->second : nullptr;
}

void RapidModule::add_parameters(std::string_view text, const RapidStatement& statement) {
  const std::size_t open = text.find('(', statement.span.begin);
  if (open >= statement.span.end) return;
  visit_rapid_names(text, open, statement.span.end, [&](Span name) {
    const RapidToken next = rapid_token_at(text, name.end, statement.span.end);
    for (const char c : {',', ')', '{', '|'})
      if (is_symbol(text, next, c)) data_[key(part(text, name), routine_count_)].name = part(text, name);
  });
}

void RapidModule::declare(std::string_view text, const RapidStatement& statement) {
  if (statement.kind == RapidKind::routine_begin) {
    sections_.push_back({statement.span.begin, ++routine_count_});
    if (const std::string name = name_of_routine(text, statement); !name.empty())
      routines_[name].writes_arguments = has_reference_parameters(text, statement);
    return add_parameters(text, statement);
  }
  if (statement.kind == RapidKind::routine_end) sections_.push_back({statement.span.begin, 0});
  const RapidDeclaration declaration = rapid_declaration(text, statement);
  if (empty(declaration.name)) return;
  RapidDatum datum{.type = declaration.type,
                   .name = std::string(part(text, declaration.name)),
                   .span = declaration.value,
                   .constant = declaration.constant,
                   .array = declaration.array};
  if (datum.type != target_type) datum.value = in_one_line(part(text, declaration.value));
  data_.insert_or_assign(key(datum.name, routine_at(statement.span.begin)), std::move(datum));
}

void RapidModule::add_changes(std::string_view text, const RapidStatement& statement, int line) {
  const auto change = [&](RapidDatum& datum) {
    if (!datum.constant && datum.computed_in == 0) datum.computed_in = line;
  };
  for (const Span name : names_changed_by(text, statement, routines_))
    if (const auto found = data_.find(key_of(part(text, name), name.begin)); found != data_.end())
      change(found->second);
  if (statement.kind != RapidKind::call) return;
  calls_.insert(statement.head);
  if (statement.head == "SETDATAVAL" || statement.head == "SETALLDATAVAL")  // by names in strings
    for (auto& entry : data_) change(entry.second);
}

void RapidModule::add_uses(std::string_view text, const RapidStatement& statement, int line) {
  const Span declared = rapid_declaration(text, statement).name;
  RapidStatement last = statement;
  for (; last.kind == RapidKind::short_if;
       last = rapid_statement_at(text, statement_of_short_if(text, last), last.behind))
    add_changes(text, last, line);
  add_changes(text, last, line);
  visit_rapid_names(text, statement.span.begin, statement.span.end, [&](Span name) {
    if (name.begin == declared.begin) return;
    if (const auto found = data_.find(key_of(part(text, name), name.begin)); found != data_.end())
      ++found->second.uses;
  });
}

void RapidModule::scan(std::string_view text, const CallNames& harmless) {
  const auto each_statement = [&](const auto& visit) {
    RapidStatement statement;
    do {
      statement = rapid_statement_at(text, statement.behind, text.size());
      visit(statement);
    } while (statement.kind != RapidKind::none && statement.kind != RapidKind::module_end);
  };
  each_statement([&](const RapidStatement& statement) { declare(text, statement); });
  int line = 1;
  std::size_t counted = 0;
  StillRoutines still(harmless);
  each_statement([&](const RapidStatement& statement) {
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(counted);
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(statement.span.begin);
    line += static_cast<int>(std::count(begin, end, '\n'));
    counted = statement.span.begin;
    add_uses(text, statement, line);
    still.add(text, statement);
  });
  still_ = still.finish();
}

void RapidScan::add(std::string_view lines) {
  RobotLine line;
  while (!far_ && next_robot_line(lines, rapid_comment, line)) {
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const RapidStatement statement = rapid_statement_at(lines, at, line.code.end);
      still_.add(lines, statement);
      const bool begins = statement.kind == RapidKind::routine_begin;
      const RapidDeclaration declared = rapid_declaration(lines, statement);
      const bool early = !in_routines_ && declared.type != target_type && declared.type != "ZONEDATA";
      const RapidToken next = rapid_token_at(lines, statement.rest, statement.span.end);
      const bool has_arguments = next.kind != RapidTokenKind::none;
      const bool changes = statement.kind == RapidKind::call && !only_reads(statement.head);
      far_ = far_ || !statement.ended || (!empty(declared.name) && !early) || (changes && has_arguments) ||
             !names_changed_by(lines, statement, {}).empty() || statement.kind == RapidKind::short_if ||
             statement.head == "CIRPATHMODE";
      if (begins) {
        const RapidToken open = rapid_token_at(lines, lines.find('(', statement.span.begin), line.code.end);
        const RapidToken first = rapid_token_at(lines, open.span.end, line.code.end);
        const std::string name = name_of_routine(lines, statement);
        far_ = far_ || is_motionless_instruction(name) || only_reads(name);
        far_ = far_ || (statement.head != "TRAP" && !is_symbol(lines, first, ')'));
      }
      in_routines_ = in_routines_ || begins;
      at = statement.behind;
    }
  }
}

bool rapid_depends_on_far_lines(std::string_view text) {
  const CallNames harmless;
  RapidScan scan(harmless);
  scan.add(text);
  return scan.depends_on_far_lines();
}

}  // namespace counterflex
