#include "counterflex/program/kept_words.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "counterflex/program/read_program.hpp"
#include "program/dialect.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"
#include "program/klartext/kept_words.hpp"
#include "program/robot/apt/lex.hpp"
#include "program/robot/fanuc/guard.hpp"
#include "program/robot/fanuc/kept_words.hpp"
#include "program/robot/kept_words.hpp"
#include "program/robot/kuka/lex.hpp"
#include "program/robot/rapid/kept_words.hpp"
#include "program/robot/rapid/lex.hpp"
#include "program/robot/ur/kept_words.hpp"
#include "program/robot/ur/lex.hpp"
#include "program/robot/yaskawa/kept_words.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"
#include "program/write/kept_words.hpp"

namespace counterflex {

namespace {

/// Empty for a language that is compared in another way.
std::optional<StatementForm> statement_form(const std::string& dialect) {
  if (dialect == kuka_name)
    return StatementForm{.comment_mark = krl_comment, .has_named_numbers = true, .may_lack_numbers = true};
  if (dialect == abb_name) return StatementForm{.comment_mark = rapid_comment};
  if (dialect == ur_name) return StatementForm{.comment_mark = ur_comment};
  if (dialect == apt_name) return StatementForm{.comment_mark = apt_comment, .may_lack_numbers = true};
  return std::nullopt;
}

/// Letters of the feed word at `i`; of F alone one.
std::size_t feed_name_size(const std::string& words, std::size_t i) {
  for (const std::string_view name : {"FMAX", "FAUTO", "FU", "FZ", "FT"})
    if (words.compare(i, name.size(), name) == 0) return name.size();
  return 1;
}

}  // namespace

double turned_deg(const OrientationNumbers& start, const OrientationNumbers& end) {
  return std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
}

double turned_deg(const Move& move) {
  if (!move.orientation || !move.orientation->by_angles) return 0;
  return turned_deg(move.orientation->start, move.orientation->end);
}

bool only_turns(const Move& move) {
  const bool known = all_known(move.known_start) && all_known(move.known_end);
  return known && move.motion == Motion::feed && !move.arc && move.start_mm == move.end_mm &&
         turned_deg(move) > short_turn_deg;
}

std::string kept_words(const Program& program, const Move& move) {
  if (program.dialect == klartext_name) return klartext_kept_words(program, move);
  if (program.dialect == tp_name) return tp_kept_words(program, move);
  if (program.dialect == yaskawa_name) return jbi_kept_words(program, move);
  auto form = statement_form(program.dialect);
  if (!form) return gcode_kept_words(program, move);
  if (program.dialect == ur_name) describe_ur_statement(program.text, move, *form);
  if (program.dialect == abb_name) describe_rapid_statement(program.text, move, *form);
  return statement_kept_words(program, move, *form);
}

std::string declared_kept_words(const Program& program, Span within, const std::vector<Span>& numbers) {
  return target_kept_words(program.text, within, numbers,
                           statement_form(program.dialect).value_or(StatementForm{}));
}

std::string line_kept_words(const Program& program, std::string_view line, std::string rest) {
  if (program.dialect == klartext_name) return klartext_line_kept_words(rest);
  if (program.dialect != yaskawa_name || !is_jbi_counts(line)) return rest;
  return jbi_surplus(program.text, line);
}

void ActingWords::read(const Program& program, Span line) {
  if (program.dialect == klartext_name)
    words_ = klartext_pole_behind(part(program.text, line), std::move(words_));
  else if (!is_robot_dialect(program.dialect))
    follow_arc_word(program, line, words_);
}

std::string ActingWords::of(const Program& program, const Move& move) {
  if (program.dialect == klartext_name) return needs_klartext_pole(program.text, move) ? words_ : "";
  return is_robot_dialect(program.dialect) ? "" : take_arc_word(program, move, words_);
}

PositionWords::PositionWords(const Program& program) {
  if (program.dialect == yaskawa_name) job_ = std::make_unique<const JbiPositionWords>(program);
}

PositionWords::~PositionWords() = default;

std::string PositionWords::of(const Move& move) const {
  return job_ ? job_->of(move.block, !target_numbers(move).empty()) : "";
}

std::string PositionWords::of(Span line) const {
  return job_ ? job_->of(line, false) : "";
}

std::optional<std::string> line_of_guard(const Program& program, std::size_t begin) {
  const std::string_view text = program.text;
  std::string_view line = text.substr(begin, std::min(text.find('\n', begin), text.size()) - begin);
  const bool is_tp = program.dialect == tp_name;
  if (is_tp) line.remove_prefix(std::min(line.find(':'), line.size()));
  if (program.dialect == klartext_name)
    line.remove_prefix(std::min(line.find_first_not_of(" 0123456789"), line.size()));
  if (!(is_tp ? is_tp_guard_line(text, begin) : is_guard_line(line))) return std::nullopt;
  return std::string(line.substr(0, line.find_last_not_of(" \t\r") + 1));
}

std::vector<std::string> lines_of_guard(const std::string& dialect, const Guard& guard) {
  Program program;
  program.dialect = dialect;
  program.text = guard_text(dialect, guard, "\n");
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < program.text.size(); begin = program.text.find('\n', begin) + 1)
    if (auto line = line_of_guard(program, begin)) lines.push_back(std::move(*line));
  return lines;
}

bool are_alike(const std::string& a, const std::string& b) {
  const std::size_t mark_a = a.find(auxiliary_mark), mark_b = b.find(auxiliary_mark);
  if ((mark_a == std::string::npos) == (mark_b == std::string::npos)) return a == b;
  return std::string_view(a).substr(0, mark_a) == std::string_view(b).substr(0, mark_b);
}

bool is_first_piece(const Move& move, const std::string& words) {
  return move.motion == Motion::feed && !changes_height_inside(move) && (move.sets_force || !is_plain(words));
}

std::string feed_word(const std::string& words) {
  const auto is_letter_at = [&](std::size_t i) { return upper(words[i]) >= 'A' && upper(words[i]) <= 'Z'; };
  for (std::size_t i = 0; i < words.size() && words[i] != ';'; ++i) {
    if (words[i] == '(') i = std::min(words.find(')', i), words.size() - 1);
    if (upper(words[i]) != 'F') continue;
    std::size_t end = i + feed_name_size(words, i);
    for (int brackets = 0; end < words.size(); ++end) {
      brackets += (words[end] == '[') - (words[end] == ']');
      if (brackets == 0 && (is_letter_at(end) || words[end] == '(' || words[end] == ';')) break;
    }
    return words.substr(i, end - i);
  }
  return {};
}

bool is_plain(const std::string& words) {
  for (std::size_t i = 0; i < words.size() && words[i] != ';'; ++i) {
    const char c = upper(words[i]);
    if (c == '(') i = std::min(words.find(')', i), words.size() - 1);
    if (c >= 'A' && c <= 'Z' && c != 'F') return false;
    if (c == 'F') i += feed_name_size(words, i) - 1;
  }
  return true;
}

}  // namespace counterflex
