#include "program/robot/rapid/module.hpp"

#include <algorithm>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view target_type = "ROBTARGET";

/// The name of the routine that `statement` begins, in upper case. The type of a function precedes it.
std::string name_of_routine(std::string_view text, const RapidStatement& statement) {
  if (statement.head == "TRAP") return {};  // is not called
  RapidToken name = rapid_token_at(text, statement.rest - statement.head.size(), statement.span.end);
  std::string word;
  for (; name.kind == RapidTokenKind::name; name = rapid_token_at(text, name.span.end, statement.span.end))
    word = rapid_word(part(text, name.span));
  return word;
}

bool is_move(std::string_view head) {
  return head == "MOVEL" || head == "MOVEJ" || head == "MOVEC" || head == "MOVEABSJ";
}

/// Whether an instruction may change the data that are its arguments.
bool may_change_arguments(std::string_view head) {
  return !is_move(head) && !is_motionless_instruction(head);
}

/// Names of a statement that may be data: not members, options or the instruction itself.
template <typename Visit>
void visit_names(std::string_view text, std::size_t at, std::size_t end, const Visit& visit) {
  RapidToken before;
  for (;;) {
    const RapidToken token = rapid_token_at(text, at, end);
    if (token.kind == RapidTokenKind::none) return;
    const bool is_part = is_symbol(text, before, '.') || is_symbol(text, before, '\\');
    if (token.kind == RapidTokenKind::name && !is_part) visit(token.span);
    before = token;
    at = token.span.end;
  }
}

/// Key of a datum of routine `routine`; 0: of the module.
std::string key(std::string_view name, std::size_t routine) {
  std::string key = rapid_word(name);
  return routine == 0 ? key : key + ' ' + std::to_string(routine);
}

}  // namespace

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
  visit_names(text, open, statement.span.end, [&](Span name) {
    const RapidToken next = rapid_token_at(text, name.end, statement.span.end);
    for (const char c : {',', ')', '{', '|'})
      if (is_symbol(text, next, c)) data_[key(part(text, name), routine_count_)].name = part(text, name);
  });
}

void RapidModule::declare(std::string_view text, const RapidStatement& statement) {
  if (statement.kind == RapidKind::routine_begin) {
    sections_.push_back({statement.span.begin, ++routine_count_});
    names_of_routines_.insert(name_of_routine(text, statement));
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
  const auto change_named = [&](Span name) {
    if (const auto found = data_.find(key_of(part(text, name), name.begin)); found != data_.end())
      change(found->second);
  };
  if (statement.kind == RapidKind::assignment)
    change_named(rapid_token_at(text, statement.span.begin, statement.span.end).span);
  if (statement.kind != RapidKind::call) return;
  calls_.insert(statement.head);
  if (statement.head == "SETDATAVAL" || statement.head == "SETALLDATAVAL")  // by names in strings
    for (auto& entry : data_) change(entry.second);
  if (may_change_arguments(statement.head))
    visit_names(text, statement.rest, statement.span.end, change_named);
}

void RapidModule::add_uses(std::string_view text, const RapidStatement& statement, int line) {
  const Span declared = rapid_declaration(text, statement).name;
  if (statement.kind == RapidKind::short_if) {
    const std::size_t at = statement_of_short_if(text, statement);
    add_changes(text, rapid_statement_at(text, at, statement.behind), line);
  }
  add_changes(text, statement, line);
  visit_names(text, statement.span.begin, statement.span.end, [&](Span name) {
    if (name.begin == declared.begin) return;
    if (const auto found = data_.find(key_of(part(text, name), name.begin)); found != data_.end())
      ++found->second.uses;
  });
}

void RapidModule::scan(std::string_view text) {
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
  each_statement([&](const RapidStatement& statement) {
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(counted);
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(statement.span.begin);
    line += static_cast<int>(std::count(begin, end, '\n'));
    counted = statement.span.begin;
    add_uses(text, statement, line);
  });
}

void RapidScan::add(std::string_view lines) {
  RobotLine line;
  while (!far_ && next_robot_line(lines, rapid_comment, line)) {
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const RapidStatement statement = rapid_statement_at(lines, at, line.code.end);
      const bool begins = statement.kind == RapidKind::routine_begin;
      const RapidDeclaration declared = rapid_declaration(lines, statement);
      const bool early = !in_routines_ && declared.type != target_type && declared.type != "ZONEDATA";
      const RapidToken next = rapid_token_at(lines, statement.rest, statement.span.end);
      const bool has_arguments = next.kind != RapidTokenKind::none;
      const bool changes = statement.kind == RapidKind::call && may_change_arguments(statement.head);
      far_ = far_ || !statement.ended || (!empty(declared.name) && !early) ||
             statement.kind == RapidKind::assignment || (changes && has_arguments) ||
             statement.kind == RapidKind::short_if || statement.head == "CIRPATHMODE";
      if (begins) {
        const RapidToken open = rapid_token_at(lines, lines.find('(', statement.span.begin), line.code.end);
        const RapidToken first = rapid_token_at(lines, open.span.end, line.code.end);
        far_ = far_ || is_motionless_instruction(name_of_routine(lines, statement));
        far_ = far_ || (statement.head != "TRAP" && !is_symbol(lines, first, ')'));
      }
      in_routines_ = in_routines_ || begins;
      at = statement.behind;
    }
  }
}

bool rapid_depends_on_far_lines(std::string_view text) {
  RapidScan scan;
  scan.add(text);
  return scan.depends_on_far_lines();
}

}  // namespace counterflex
