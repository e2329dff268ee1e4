#include "program/robot/kuka/writer.hpp"

#include <algorithm>

#include "program/dialect.hpp"
#include "program/robot/kuka/lex.hpp"
#include "program/robot/kuka/loops.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::string_view krl_axes = "XYZ", krl_angles = "CBA";  // about X, Y, Z

/// The statement of `move`, without its comment.
RobotLine line_of(const Program& program, const Move& move) {
  RobotLine line;
  line.line_end.end = move.block.begin;
  next_robot_line(program.text, krl_comment, line);
  return line;
}

/// The aggregates in the line of `move`: the auxiliary point of CIRC, and the target.
std::vector<KrlAggregate> aggregates_of(const Program& program, const Move& move) {
  std::vector<KrlAggregate> all;
  const Span code = line_of(program, move).code;
  for (std::size_t at = code.begin; (at = program.text.find('{', at)) < code.end; ++at)
    if (auto aggregate = aggregate_at(program.text, at, code.end)) {
      at = aggregate->span.end - 1;
      all.push_back(std::move(*aggregate));
    }
  return all;
}

/// "CIRC {...}, {...}" becomes "LIN {...}": the keyword, and the auxiliary point with the comma behind it.
void change_to_line(const Program& program, const Move& move, std::vector<TextChange>& changes) {
  const Span code = line_of(program, move).code;
  const Span keyword = name_at(program.text, code.begin, code.end);
  const bool lower_case = program.text[keyword.begin] == 'c';
  const std::vector<KrlAggregate> aggregates = aggregates_of(program, move);
  if (aggregates.size() != 2) return;
  changes.push_back({keyword, lower_case ? "lin" : "LIN"});
  changes.push_back({{aggregates[0].span.begin, aggregates[1].span.begin}, ""});
}

/// The text between components: "," or ", ".
std::string separator_of(std::string_view text, const KrlAggregate& aggregate) {
  if (aggregate.components.size() < 2) return ",";
  return std::string(part(text, {aggregate.components[0].span.end, aggregate.components[1].span.begin}));
}

/// Components that the target does not have, in the order of the names.
std::vector<std::string> missing_components(const Move& move, const TargetNumbers& numbers) {
  std::vector<std::string> missing;
  const auto add = [&](const PackedAxisWord& word, const std::optional<WordNumber>& number, char name) {
    if (!word && number)
      missing.push_back(std::string(1, name) + ' ' + inserted_number(number->value, number->decimals));
  };
  for (std::size_t axis = 0; axis < 3; ++axis) add(move.words[axis], numbers.position[axis], krl_axes[axis]);
  for (std::size_t i = 3; move.orientation && i-- > 0;)
    add(move.orientation->words[i], numbers.orientation[i], krl_angles[i]);
  return missing;
}

/// Missing components are inserted behind those of the position and orientation, before S, T and E1.
void insert_missing(std::string_view text, const KrlAggregate& target,
                    const std::vector<std::string>& missing, std::vector<TextChange>& changes) {
  if (missing.empty()) return;
  const std::string separator = separator_of(text, target);
  const auto& components = target.components;
  const auto last = std::find_if(components.rbegin(), components.rend(), [](const KrlComponent& c) {
    return c.name.size() == 1 && std::string_view("XYZABC").find(c.name[0]) != std::string_view::npos;
  });
  const bool behind = last != components.rend();
  std::string inserted;
  for (const std::string& component : missing)
    inserted += behind ? separator + component : component + separator;
  const std::size_t at = behind ? last->span.end : components.front().span.begin;
  changes.push_back({{at, at}, std::move(inserted)});
}

/// The name behind the keyword of a move to a named target.
Span name_of_target(const Program& program, const Move& move) {
  const Span code = line_of(program, move).code;
  const Span keyword = name_at(program.text, code.begin, code.end);
  return variable_at(program.text, behind_blanks(program.text, keyword.end, code.end), code.end);
}

/// The aggregate that has the numbers of the target of `move`, in its line or in another one.
std::optional<KrlAggregate> target_of(const Program& program, const Move& move) {
  std::optional<std::size_t> number;
  for (const PackedAxisWord& word : move.words)
    if (word) number = word->number.begin;
  for (std::size_t i = 0; move.orientation && i < move.orientation->words.size(); ++i)
    if (const PackedAxisWord& word = move.orientation->words[i]) number = word->number.begin;
  if (!number) return std::nullopt;
  return aggregate_at(program.text, program.text.rfind('{', *number), program.text.size());
}

}  // namespace

KukaWriter::KukaWriter(const Program& window, const WriteOptions& options)
    : RobotWriter(window, options, krl_comment) {
  if (names_targets(window.text)) uses_ = uses_of_names(window.text);
}

/// Targets that were inserted into the array of a loop have the index of the target behind them. They are
/// counted here.
Rewritten KukaWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  Rewritten out = RobotWriter::write(window, edits);
  if (!numbering_) numbering_ = numbering_in(window.text);
  if (numbering_)
    out.text = numbering_->numbered(std::move(out.text));
  else if (out.inserted_blocks > 0)
    out.text = with_counted_arrays(std::move(out.text), window.file);
  return out;
}

bool KukaWriter::has_declaration_of_its_own(const Program& program, const Move& move) const {
  const auto uses = uses_.find(krl_word(part(program.text, name_of_target(program, move))));
  return uses != uses_.end() && uses->second == 2;  // the assignment and the move
}

/// Behind DEF: before it only the attributes of the file ("&ACCESS") are allowed.
std::size_t KukaWriter::header_position(const Program& program) const {
  RobotLine line;
  while (next_robot_line(program.text, krl_comment, line)) {
    if (begins_routine(program.text, line)) return line.line_end.end;
    if (!empty(line.code) && program.text[line.code.begin] != '&') break;
  }
  return byte_order_mark(program.text);
}

/// A named target is changed where it is declared. If other statements use it, and in copies, its aggregate
/// with the new numbers takes the place of its name.
void KukaWriter::change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                               std::vector<TextChange>& changes) const {
  const std::vector<KrlAggregate> own_line = aggregates_of(program, move);
  const bool in_line = !own_line.empty();
  std::optional<KrlAggregate> target = target_of(program, move);
  if (!target && in_line) target = own_line.back();
  if (!target) return;
  std::vector<TextChange> own;
  RobotWriter::change_target(program, move, numbers, own);
  insert_missing(program.text, *target, missing_components(move, numbers), own);
  if (numbers.becomes_line) change_to_line(program, move, own);
  const bool at_its_place = in_line || (!numbers.is_copy && has_declaration_of_its_own(program, move));
  if (at_its_place)
    changes.insert(changes.end(), own.begin(), own.end());
  else if (numbers.is_copy || !own.empty())
    changes.push_back({name_of_target(program, move), with_changes(program.text, target->span, own)});
}

}  // namespace counterflex
