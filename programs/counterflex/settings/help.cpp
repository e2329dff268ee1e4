#include "settings/help.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>

#include "counterflex/files/text.hpp"
#include "process/terminal.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view usage =
    "Usage: counterflex COMMAND [OPTION...]\n"
    "       counterflex PROGRAM [OPTION...]      as counterflex compensate PROGRAM\n"
    "\n"
    "  counterflex check O1001.NC                             what can be corrected in a program\n"
    "  counterflex check machine.toml                         what a machine file describes\n"
    "  counterflex predict O1001.NC -m machine.toml           the deviation and its causes\n"
    "  counterflex O1001.NC -m machine.toml --report O1001    the corrected program and a page\n";

constexpr std::size_t least_width = 60, most_width = 100;

/// Columns of the terminal: COLUMNS, else the width of the terminal.
std::size_t width_of_terminal() {
  std::size_t columns = 0;
  const char* variable = std::getenv("COLUMNS");
  if (const auto number = read_number(variable == nullptr ? "" : variable); number && *number > 0)
    columns = static_cast<std::size_t>(std::min(*number, 1e4));
  if (columns == 0) columns = columns_of(STDOUT_FILENO);
  return columns == 0 ? most_width : std::clamp(columns, least_width, most_width);
}

constexpr std::array shown_groups{group::common,     group::forces, group::reading,
                                  group::correction, group::output, group::settings};

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() : width_(width_of_terminal()) { column_width(width_ >= 80 ? 30 : 22); }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
    const std::string full = app->get_parent() != nullptr && app->get_name() == name
                                 ? app->get_parent()->get_name() + " " + name
                                 : name;
    std::string text = paragraph(app->get_description()) + "\n" + make_usage(app, full);
    const bool is_command = app->get_parent() != nullptr;
    if (is_command) text += "\n" + app->get_footer() + "\n";
    text += make_subcommands(app, mode) + make_positionals(app);
    for (const std::string_view shown : shown_groups) text += options_of(*app, std::string(shown));
    if (!is_command) text += "\n" + app->get_footer() + "\n";
    return text;
  }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() == nullptr) return std::string(usage);
    std::string text = "Usage: " + name;
    for (const CLI::Option* option :
         app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      text += " " + make_option_usage(option);
    return text + " [OPTION...]\n";
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return row(make_option_name(option, is_positional) + make_option_opts(option), option->get_description());
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string type = option->get_type_name();
    return option->get_positional() || type.empty() ? "" : " " + type;
  }

  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode) const override {
    std::string text;
    for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; }))
      text += row(command->get_name(), command->get_description());
    return text.empty() ? text
                        : "\nCommands:\n" + text + row("help", "Explain a command: counterflex help COMMAND");
  }

 private:
  std::string options_of(const CLI::App& app, const std::string& named) const {
    std::string text;
    for (const CLI::Option* option :
         app.get_options([&](const CLI::Option* o) { return o->get_group() == named && o->nonpositional(); }))
      text += make_option(option, false);
    return text.empty() ? text : fmt::format("\n{}:\n{}", named, text);
  }

  /// A name and what it means, in two columns.
  std::string row(const std::string& name, const std::string& meaning) const {
    const std::size_t column = get_column_width();
    std::string text = "  " + name;
    if (text.size() + 2 > column)
      text += "\n";
    else
      text.resize(column, ' ');
    return text + broken(meaning, text.ends_with('\n') ? 0 : column, column);
  }

  std::string paragraph(const std::string& text) const { return broken(text, 0, 0); }

  /// `text` in lines of the width; the first begins at column `from`, the others at `indent`.
  std::string broken(const std::string& text, std::size_t from, std::size_t indent) const {
    std::string result;
    std::size_t at = from;
    if (from < indent) result.append(indent - from, ' '), at = indent;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      const std::string word = text.substr(begin, end - begin);
      if (at > indent && at + 1 + word.size() > width_) {
        result.append("\n").append(indent, ' ');
        at = indent;
      } else if (at > indent) {
        result += ' ';
        ++at;
      }
      result += word;
      at += word.size();
      begin = end + 1;
    }
    return result + "\n";
  }

  std::size_t width_;
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_formatter() {
  return std::make_shared<HelpFormatter>();
}

std::string short_usage() {
  return std::string(usage) +
         "\ncounterflex help lists the commands; counterflex help COMMAND explains one.\n";
}

}  // namespace counterflex::cli
