#include "settings/completion.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

const std::string compensate = "compensate";  ///< the command of a program alone

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

/// "mm inch" of an option with the type "mm|inch"; empty where any value is possible.
std::string choices_of(const CLI::Option& option) {
  std::string type = option.get_type_name();
  if (type.find('|') == std::string::npos) return "";
  std::ranges::replace(type, '|', ' ');
  return type;
}

/// Whether the value is the name of a file.
bool names_file(const CLI::Option& option) {
  constexpr std::array<std::string_view, 6> types{"MACHINE", "FORCES", "FILE", "FILE.svg", "OUTPUT", "STEM"};
  return std::ranges::find(types, option.get_type_name()) != types.end();
}

/// "-m --machine".
std::string names_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += " -" + name;
  for (const std::string& name : option.get_lnames()) names += " --" + name;
  return names.substr(1);
}

/// Without characters that mean something between single quotes or in brackets.
std::string plain(std::string text) {
  std::erase(text, '\'');
  std::ranges::replace(text, '[', '(');
  std::ranges::replace(text, ']', ')');
  std::ranges::replace(text, ':', ';');
  return text;
}

std::string long_names(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : options_of(app))
    for (const std::string& name : option->get_lnames()) names += " --" + name;
  return names.substr(1);
}

std::string bash_script(const CLI::App& app) {
  std::string commands, options, values;
  std::vector<std::string> seen;
  for (const CLI::App* command : commands_of(app)) {
    commands += command->get_name() + " ";
    options += fmt::format("    {}) echo '{}' ;;\n", command->get_name(), long_names(*command));
    for (const CLI::Option* option : options_of(*command)) {
      const std::string name = option->get_lnames().front();
      if (choices_of(*option).empty() || std::ranges::find(seen, name) != seen.end()) continue;
      seen.push_back(name);
      values += fmt::format("    --{}) values='{}' ;;\n", name, choices_of(*option));
    }
  }
  return fmt::format(R"sh(# bash completion of counterflex
_counterflex_words() {{
  case $1 in
{}    *) echo '{}help {}' ;;
  esac
}}

# The command whose options are completed, by the first word: a program alone is compensated.
_counterflex_command() {{
  if [[ ($1 == - || $1 != -*) && " $(_counterflex_words '') " != *" $1 "* ]]; then echo {}; else echo "$1"; fi
}}

_counterflex() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} values=''
  COMPREPLY=()
  case $previous in
{}    help) values='{}' ;;
    *) if [[ $COMP_CWORD -eq 1 || $current == -* ]]; then
         values=$(_counterflex_words "$([ "$COMP_CWORD" -gt 1 ] && _counterflex_command "${{COMP_WORDS[1]}}")")
       fi ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
}}

complete -o default -F _counterflex counterflex
)sh",
                     options, commands, long_names(app), compensate, values, commands);
}

std::string zsh_option(const CLI::Option& option) {
  std::string names = names_of(option);
  if (names.find(' ') != std::string::npos) {
    std::ranges::replace(names, ' ', ',');
    names = "'{" + names + "}'";
  }
  const std::string meaning = "[" + plain(option.get_description()) + "]";
  if (option.get_type_name().empty()) return fmt::format("'{}{}'", names, meaning);
  const std::string choices = choices_of(option);
  const std::string action = !choices.empty() ? "(" + choices + ")" : names_file(option) ? "_files" : "";
  return fmt::format("'*{}{}:{}:{}'", names, meaning, plain(option.get_type_name()), action);
}

std::string zsh_options(const CLI::App& command, std::string_view pattern) {
  std::string text = fmt::format("    {}) _arguments", pattern);
  for (const CLI::Option* option : options_of(command)) text += " \\\n      " + zsh_option(*option);
  return text + " \\\n      '*:file:_files' ;;\n";
}

// A program alone is compensated.
std::string zsh_script(const CLI::App& app) {
  std::string commands, options;
  for (const CLI::App* command : commands_of(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), plain(command->get_description()));
    if (command->get_name() != compensate) options += zsh_options(*command, command->get_name());
  }
  options += "    help) _describe command commands ;;\n" + zsh_options(*app.get_subcommand(compensate), "*");
  return fmt::format(R"sh(#compdef counterflex
# zsh completion of counterflex
_counterflex() {{
  local -a commands=(
{}    'help:Explain a command'
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _files
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
_counterflex "$@"
)sh",
                     commands, options);
}

std::string fish_option(const CLI::Option& option, const std::string& condition) {
  std::string line = "complete -c counterflex" + condition;
  for (const std::string& name : option.get_snames()) line += " -s " + name;
  for (const std::string& name : option.get_lnames()) line += " -l " + name;
  const std::string choices = choices_of(option);
  if (!choices.empty())
    line += " -xa '" + choices + "'";
  else if (names_file(option))
    line += " -rF";
  else if (!option.get_type_name().empty())
    line += " -x";
  return line + " -d '" + plain(option.get_description()) + "'\n";
}

std::string fish_script(const CLI::App& app) {
  std::string text = "# fish completion of counterflex\n";
  for (const CLI::App* command : commands_of(app))
    text += fmt::format("complete -c counterflex -n __fish_use_subcommand -a {} -d '{}'\n",
                        command->get_name(), plain(command->get_description()));
  text += "complete -c counterflex -n __fish_use_subcommand -a help -d 'Explain a command'\n";
  for (const CLI::Option* option : options_of(app)) text += fish_option(*option, " -n __fish_use_subcommand");
  std::string others;
  for (const CLI::App* command : commands_of(app))
    if (command->get_name() != compensate) others += " " + command->get_name();
  for (const CLI::App* command : commands_of(app)) {
    const bool is_default = command->get_name() == compensate;
    const std::string condition = (is_default ? "not __fish_seen_subcommand_from help" + others
                                              : "__fish_seen_subcommand_from " + command->get_name());
    for (const CLI::Option* option : options_of(*command))
      text += fish_option(*option, fmt::format(" -n '{}'", condition));
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_script(app);
  if (shell == "zsh") return zsh_script(app);
  if (shell == "fish") return fish_script(app);
  throw InputError(ErrorKind::usage, {},
                   fmt::format("'{}' is not a shell with completion: bash, zsh or fish", shell));
}

}  // namespace counterflex::cli
