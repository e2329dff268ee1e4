#include "program/text/operation.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::string_view header_mark = "COUNTERFLEX 1";
constexpr std::string_view marks_around = " \t\r-*=_#~;";

std::string_view without_marks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(marks_around);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(marks_around) + 1 - begin);
}

/// Ignores case, as LinuxCNC does.
bool begins_so(std::string_view text, std::string_view capitals) {
  const auto same = [](char c, char capital) { return upper(c) == capital; };
  return text.size() >= capitals.size() && std::equal(capitals.begin(), capitals.end(), text.begin(),
                                                      [&](char a, char b) { return same(b, a); });
}

/// Whether a comment is a command for LinuxCNC: it shows a text, logs, or runs a script.
bool is_active(std::string_view comment) {
  constexpr std::array<std::string_view, 10> orders = {
      "MSG,", "DEBUG,", "PRINT,", "LOG,", "LOGOPEN,", "LOGAPPEND,", "PROBEOPEN ", "PY,", "PYRUN,", "ABORT,"};
  constexpr std::array<std::string_view, 3> alone = {"LOGCLOSE", "PROBECLOSE", "PYRELOAD"};
  const auto begins = [&](std::string_view order) { return begins_so(comment, order); };
  const auto is = [&](std::string_view order) { return comment.size() == order.size() && begins(order); };
  return std::any_of(orders.begin(), orders.end(), begins) || std::any_of(alone.begin(), alone.end(), is);
}

}  // namespace

bool is_header_comment(std::string_view comment) {
  comment.remove_prefix(std::min(comment.find_first_not_of(" \t"), comment.size()));
  return comment.starts_with(header_mark) &&
         (comment.size() == header_mark.size() || comment[header_mark.size()] == ' ');
}

bool has_comments_alone(std::string_view text, const Block& block) {
  if (block.comments.empty() || block.percent || block.part_name) return false;
  const bool numbered = block.words.size() == 1 && block.words[0].letter == 'N';
  if (numbered ? block.assigns || !empty(block.flow_keyword) : has_content(block)) return false;
  if (block.statement != Statement::none) return false;
  // Names without an effect on moves have no word.
  const std::string_view before = part(text, {block.span.begin, block.comments[0].begin - 1});
  return std::all_of(before.begin(), before.end(), [](char c) {
    return is_blank(c) || is_digit(c) || c == 'N' || c == 'n' || c == '/' || is_ignored(c);
  });
}

std::string_view operation_name(std::string_view comment) {
  if (is_header_comment(comment)) return {};
  std::string_view name = without_marks(comment);
  // "; (POCKET)" is one comment in two forms.
  if (name.starts_with(comment_open) && name.find(comment_close) + 1 == name.size())
    name = without_marks(name.substr(1, name.size() - 2));
  return is_active(name) ? std::string_view{} : name;
}

bool CurrentOperation::name(std::string_view comment, std::int32_t tool) {
  const std::string_view name = operation_name(comment);
  if (name.empty()) return false;
  const bool is_title = expects_title_ || (tool != tool_ && !has_title_);
  is_new_ = is_new_ || name != text_ || (is_title && name != title_);
  text_ = name;
  if (is_title) title_ = name;
  has_title_ = has_title_ || is_title;
  tool_ = tool;
  expects_title_ = false;
  return true;
}

void CurrentOperation::add_to(Program& program) {
  is_new_ = false;
  if (program.operations.back() != text_ || program.operation_titles.back() != title_) {
    program.operations.push_back(text_);
    program.operation_titles.push_back(title_);
  }
  index_ = static_cast<std::uint32_t>(program.operations.size() - 1);
}

void CurrentOperation::begin_window(Program& program) {
  std::optional<Move>& before = program.before;
  std::string of_before = before ? program.operations[before->operation] : text_;
  std::string title_before = before ? program.operation_titles[before->operation] : title_;
  program.operations.assign(1, text_);
  program.operation_titles.assign(1, title_);
  index_ = 0;
  is_new_ = false;
  if (!before) return;
  before->operation = 0;
  if (of_before == text_ && title_before == title_) return;
  program.operations.push_back(std::move(of_before));
  program.operation_titles.push_back(std::move(title_before));
  before->operation = 1;
}

}  // namespace counterflex
