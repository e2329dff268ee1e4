#include "program/detect/choose_dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "program/detect/detect_dialect.hpp"
#include "program/detect/other_machines.hpp"
#include "program/detect/robot_language.hpp"
#include "program/klartext/lex.hpp"

namespace counterflex {
namespace {

/// Whole lines, so that each comment is complete.
std::string_view beginning(std::string_view text) {
  if (text.size() < bytes_of_dialect) return text;
  text = text.substr(0, bytes_of_dialect);
  return text.substr(0, text.rfind('\n'));
}

bool ends_in(std::string_view file, std::string_view ending) {
  return file.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), file.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

/// If the text is not Klartext, the extension of the file name decides.
const Dialect& detect_dialect_of_file(std::string_view text, std::string_view file) {
  if (ends_in(file, ".h") && begins_like_klartext(text)) return *find_dialect(klartext_name);
  const Dialect& detected = detect_dialect(text);
  const bool siemens_file = ends_in(file, ".mpf") || ends_in(file, ".spf");
  return siemens_file && detected.name != klartext_name ? *find_dialect("siemens") : detected;
}

void refuse_other_dialect(std::string_view dialect, const std::string& file, const ReadOptions& options) {
  if (options.dialect == "auto" || options.dialect == dialect) return;
  throw InputError(ErrorKind::program_text, {file, 1, 1},
                   fmt::format("this is a program in {}, not in dialect '{}'; use auto or {}",
                               robot_language_of(dialect), options.dialect, dialect));
}

}  // namespace

std::optional<std::string> unknown_dialect(const std::string& dialect) {
  if (dialect == "auto" || find_dialect(dialect) != nullptr) return std::nullopt;
  return fmt::format("unknown dialect '{}'; use one of {}", dialect, dialect_names());
}

const Dialect& choose_dialect(std::string_view text, const std::string& file, const ReadOptions& options) {
  if (const std::string_view dialect = robot_dialect(text); !dialect.empty()) {
    refuse_other_dialect(dialect, file, options);
    return *find_dialect(dialect);
  }
  if (const std::string machine = other_machine(text); !machine.empty())
    throw InputError(
        ErrorKind::program_text, {file, 1, 1},
        fmt::format(
            "this is {}, which is not supported; use a milling program for Fanuc, Haas, LinuxCNC, GRBL, "
            "Mach3, Siemens or Heidenhain",
            machine));
  if (options.dialect == "auto") return detect_dialect_of_file(beginning(text), file);
  if (const auto problem = unknown_dialect(options.dialect))
    throw InputError(ErrorKind::usage, {file}, *problem);
  return *find_dialect(options.dialect);
}

std::array<bool, 3> axes_of_tool_change(const Dialect& dialect, const ReadOptions& options) {
  std::array<bool, 3> axes{};
  axes.fill(!options.tool_change_moves && dialect.tool_change_moves_axes);
  if (!options.tool_change_moves) return axes;
  for (const char letter : *options.tool_change_moves)
    if (letter >= 'X' && letter <= 'Z') axes[static_cast<std::size_t>(letter - 'X')] = true;
  return axes;
}

}  // namespace counterflex
