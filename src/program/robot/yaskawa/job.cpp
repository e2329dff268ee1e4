#include "program/robot/yaskawa/job.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "program/robot/yaskawa/motion.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto body_begins =
    std::to_array<std::string_view>({"IFTHENEXP", "IFTHEN", "IF", "WHILEEXP", "WHILE", "FOR", "SWITCH"});
constexpr auto branches = std::to_array<std::string_view>({"ELSE", "ELSEIFEXP", "ELSEIF", "CASE", "DEFAULT"});
constexpr auto body_ends = std::to_array<std::string_view>({"ENDIF", "ENDWHILE", "NEXT", "ENDSWITCH"});
/// Instructions whose first variable is only read.
constexpr auto readers = std::to_array<std::string_view>({"SFTON", "IMOV", "CALL", "REFP", "MSG"});

/// MOVC instructions without another move between them.
struct Run {
  std::vector<std::size_t> lines;   ///< their first bytes
  std::vector<std::size_t> points;  ///< indices of those with FPT
  bool interrupted = false;         ///< by a label, a condition or a call
  bool flow = false;                ///< one of these follows the last MOVC
};

/// Three points are a circle. At a point with FPT a circle ends and the next one begins.
bool is_known(const Run& run) {
  if (run.interrupted || run.lines.size() < 3 || run.lines.size() % 2 == 0) return false;
  for (std::size_t i = 1; i + 1 < run.lines.size(); ++i) {
    const bool fixed = std::find(run.points.begin(), run.points.end(), i) != run.points.end();
    if (fixed != (i % 2 == 0)) return false;
  }
  return true;
}

void end_run(Run& run, JbiJob& job) {
  const bool known = is_known(run);
  for (std::size_t i = 0; i < run.lines.size(); ++i) {
    JbiCircleStep step = i % 2 == 0 ? JbiCircleStep::end : JbiCircleStep::auxiliary;
    if (i == 0) step = JbiCircleStep::start;
    job.circles.push_back({run.lines[i], known ? step : JbiCircleStep::unknown});
  }
  run = {};
}

void add_move(std::string_view text, const RobotLine& line, std::string_view head, Run& run, JbiJob& job) {
  for (const JbiName& name : jbi_names(text, line.code))
    if (JbiPosition* position = job.positions.find(name.family, name.number)) {
      if (head == "IMOV")
        position->used_otherwise = true;
      else
        ++position->uses;
    }
  job.indexes_variables = job.indexes_variables || part(text, line.code).find("P[") != std::string_view::npos;
  if (head != "MOVC") return end_run(run, job);
  run.interrupted = run.interrupted || run.flow;
  if (jbi_motion(text, line.code).is_fixed_point) run.points.push_back(run.lines.size());
  run.lines.push_back(line.span.begin);
}

/// The number of "UF#(2)"; -1 for a variable.
long user_of(std::string_view code) {
  const std::size_t at = code.find("UF#(");
  long number = -1;
  if (at == std::string_view::npos) return number;
  std::from_chars(code.data() + at + 4, code.data() + code.size(), number);
  return number;
}

/// "PX012": the variables P012, BP012 and EX012 together.
std::optional<JbiName> name_of_all(std::string_view text, Span word) {
  if (word.end - word.begin < 3 || !jbi_word(part(text, word)).starts_with("PX")) return std::nullopt;
  JbiName name{JbiFamily::robot_variable, 0, word, {word.begin + 2, word.end}};
  const auto [end, error] =
      std::from_chars(text.data() + name.digits.begin, text.data() + word.end, name.number);
  return error == std::errc() && end == text.data() + word.end ? std::optional(name) : std::nullopt;
}

void compute_all_variables(JbiJob& job) {
  for (JbiPosition& position : job.positions.list)
    position.computed = position.computed || is_variable(position.family);
}

/// An instruction changes the variable that is its first operand.
void add_change(std::string_view text, std::string_view head, const std::vector<Span>& words, JbiJob& job) {
  if (words.size() < 2 || is_among(head, readers)) return;
  const std::string target = jbi_word(part(text, words[1]));
  if (target.starts_with("P[") || target.starts_with("PX[")) return compute_all_variables(job);
  auto name = jbi_name(text, words[1]);
  if (!name) name = name_of_all(text, words[1]);
  if (!name || !is_variable(name->family)) return;
  if (head == "CLEAR") return compute_all_variables(job);  // it clears a range
  if (JbiPosition* position = job.positions.find(name->family, name->number)) position->computed = true;
}

void add_other(std::string_view text, const RobotLine& line, std::string_view head, JbiJob& job) {
  const std::vector<Span> words = jbi_words(text, line.code);
  for (const JbiName& name : jbi_names(text, line.code))
    if (JbiPosition* position = job.positions.find(name.family, name.number)) position->used_otherwise = true;
  for (const Span word : words) {
    if (const auto name = name_of_all(text, word))
      if (JbiPosition* position = job.positions.find(name->family, name->number))
        position->used_otherwise = true;
    job.indexes_variables = job.indexes_variables || part(text, word).starts_with("P[");
  }
  add_change(text, head, words, job);
  if (head == "MFRAME") job.computed_users.insert(user_of(part(text, line.code)));
  job.shifts = job.shifts || head.ends_with("SFTON");
}

}  // namespace

JbiFlow jbi_flow(std::string_view word) {
  if (is_among(word, body_begins)) return JbiFlow::body_begin;
  if (is_among(word, branches)) return JbiFlow::branch;
  if (is_among(word, body_ends)) return JbiFlow::body_end;
  if (word.starts_with('*')) return JbiFlow::label;
  if (word == "CALL") return JbiFlow::call;
  if (word == "JUMP" || word == "RET") return JbiFlow::jump;
  return word == "END" ? JbiFlow::end : JbiFlow::none;
}

JbiJob jbi_job(std::string_view text, const std::string& file) {
  JbiJob job{.positions = jbi_positions(text, file)};
  Run run;
  RobotLine line;
  line.line_end.end = job.positions.end;
  while (next_robot_line(text, jbi_comment, line)) {
    if (empty(line.code) || text[line.code.begin] == '/') continue;
    const std::string head = jbi_word(part(text, jbi_words(text, line.code).front()));
    if (is_jbi_move(head)) {
      add_move(text, line, head, run, job);
      continue;
    }
    const JbiFlow flow = jbi_flow(head);
    if (flow == JbiFlow::end) break;
    run.flow = run.flow || (flow != JbiFlow::none && !run.lines.empty());
    add_other(text, line, head, job);
  }
  end_run(run, job);
  return job;
}

JbiCircleStep circle_step(const JbiJob& job, std::size_t line_begin) {
  const auto at =
      std::lower_bound(job.circles.begin(), job.circles.end(), line_begin,
                       [](const JbiCircle& circle, std::size_t begin) { return circle.line_begin < begin; });
  return at != job.circles.end() && at->line_begin == line_begin ? at->step : JbiCircleStep::unknown;
}

bool has_one_use(const JbiJob& job, const JbiPosition& position) {
  if (is_variable(position.family) && job.indexes_variables) return false;
  return position.uses == 1 && !position.used_otherwise;
}

}  // namespace counterflex
