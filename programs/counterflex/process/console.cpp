#include "process/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "counterflex/files/text.hpp"
#include "counterflex/program/program_files.hpp"
#include "process/progress.hpp"
#include "process/terminal.hpp"

namespace counterflex::cli {
namespace {

constexpr std::size_t warnings_shown = 20;

bool colours_on(int descriptor) {
  const char* no_colour = std::getenv("NO_COLOR");
  if (no_colour != nullptr && *no_colour != '\0') return false;
  return has_colours(descriptor);
}

/// Ignores errors: there is no other place to report them.
void write_error(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);  // Windows keeps it, and standard output would come first
}

/// Colours the first ": word: " of a diagnostic, or `word` at its beginning.
std::string painted(std::string_view diagnostic, std::string_view word, int colour) {
  std::string text(diagnostic);
  const std::string marked = fmt::format("{}: ", word);
  const std::size_t at = text.starts_with(marked) ? 0 : text.find(": " + marked);
  if (at == std::string::npos) return text;
  return text.replace(at == 0 ? 0 : at + 2, word.size() + 1,
                      fmt::format("\033[1;{}m{}:\033[0m", colour, word));
}

}  // namespace

Console::Console(Loudness loudness, ConsoleListener listener)
    : listener_(std::move(listener)),
      quiet_(loudness.quiet),
      verbose_(loudness.verbose && !loudness.quiet),
      terminal_(is_terminal(STDERR_FILENO)),
      one_terminal_(terminal_ && is_terminal(STDOUT_FILENO)),
      colour_(colours_on(STDERR_FILENO)),
      colour_out_(colours_on(STDOUT_FILENO)),
      marks_out_(shows_utf8(STDOUT_FILENO)),
      marks_error_(shows_utf8(STDERR_FILENO)) {}

Console::~Console() {
  erase_progress();
}

void Console::erase_progress() {
  if (showing_progress_ && is_ready(STDERR_FILENO)) write_error("\r\033[K");
  showing_progress_ = false;
}

void Console::name_lines(const std::string& name, const std::vector<std::string>& files,
                         const std::vector<int>& first) {
  joined_.insert_or_assign(name, JoinedFiles{files, first});
}

std::string Console::with_named_line(std::string_view diagnostic) const {
  for (const auto& [name, joined] : joined_) {
    if (!diagnostic.starts_with(name + ":")) continue;
    const std::string_view rest = diagnostic.substr(name.size() + 1);
    int line = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), line);
    if (error != std::errc() || line < 1) continue;
    const Location place = place_in_files(joined.files, joined.first, line);
    return fmt::format("{}:{}{}", shown_name(place.file), place.line,
                       rest.substr(static_cast<std::size_t>(end - rest.data())));
  }
  return std::string(diagnostic);
}

void Console::warning(const std::string& file, int line, std::string_view what) {
  const std::string text =
      without_controls(line > 0 ? with_named_line(fmt::format("{}:{}: warning: {}", file, line, what))
                                : fmt::format("{}: warning: {}", file, what));
  if (listener_.warning && texts_.insert(text).second) return listener_.warning(text);
  if (quiet_ || !texts_.insert(text).second || ++warnings_[file] > warnings_shown) return;
  erase_progress();
  write_error((colour_ ? painted(text, "warning", 35) : text) + "\n");
}

void Console::more_warnings(const std::string& file, std::size_t count) {
  if (count > 0) warnings_[file] += count;
}

void Console::finish_warnings() {
  erase_progress();
  for (const auto& [file, count] : warnings_)
    if (!quiet_ && count > warnings_shown)
      write_error(fmt::format("{}: {} more warnings; a report lists them\n", without_controls(file),
                              count - warnings_shown));
  warnings_.clear();
}

void Console::detail(std::string_view what) {
  if (!verbose_) return;
  erase_progress();
  write_error(without_controls(what) + "\n");
}

void Console::note(std::string_view text) {
  if (quiet_) return;
  erase_progress();
  write_error(std::string(text));
}

void Console::progress(std::string_view what) {
  progress_line(fmt::format("{} ...", what));
}

void Console::progress_line(std::string_view line) {
  if (quiet_ || !terminal_ || !is_ready(STDERR_FILENO)) return;
  erase_progress();
  write_error(without_controls(line));
  showing_progress_ = true;
}

void Console::solving(int line, int lines) {
  if (listener_.solving) return listener_.solving(line, lines);
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds between(100);
  const auto now = Clock::now();
  if (!begun_) begun_ = now;
  if (showing_progress_ && now - shown_at_ < between) return;
  shown_at_ = now;
  const double share = lines > 0 ? static_cast<double>(line) / lines : 0;
  progress_line(progress_bar({share, waypoints_, std::chrono::duration<double>(now - *begun_).count()}));
}

void Console::solved(std::size_t waypoints) {
  if (listener_.solved) return listener_.solved(waypoints);
  waypoints_ += waypoints;
}

void Console::error(std::string_view diagnostic) {
  if (listener_.error) return listener_.error(diagnostic);
  erase_progress();
  const std::string text = without_controls(with_named_line(diagnostic));
  write_error((colour_ ? painted(text, "error", 31) : text) + "\n");
}

std::string located(const std::string& file, const Failure& failure) {
  if (failure.line > 0) return fmt::format("{}:{}:1: error: {}", file, failure.line, failure.what);
  return fmt::format("{}: error: {}", file, failure.what);
}

std::string with_file(const std::string& diagnostic, const std::string& file) {
  return diagnostic.starts_with("error: ") ? file + ": " + diagnostic : diagnostic;
}

std::string shown_name(const std::string& path) {
  return path == "-" ? "<stdin>" : without_controls(path);
}

}  // namespace counterflex::cli
