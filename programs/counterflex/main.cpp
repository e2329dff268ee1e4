/// counterflex: corrects machining programs for the errors of their machine.
#include <malloc.h>

#include <vector>

#include "commands/commands.hpp"
#include "counterflex/report/formats.hpp"
#include "process/exit_status.hpp"
#include "process/guarded.hpp"
#include "process/signals.hpp"
#include "process/standard_output.hpp"
#include "process/terminal.hpp"
#include "process/version.hpp"
#include "settings/command_line.hpp"

namespace counterflex::cli {
namespace {

/// Prints the verdict FAILED for a run whose inputs could not be read, unless standard output is for the
/// program.
std::optional<ErrorKind> judged(counterflex::Command command,
                                std::optional<ErrorKind> (*run)(const Options&, Console&),
                                const Options& options, Console& console) {
  try {
    return run(options, console);
  } catch (const InputError& error) {
    if (options.output != "-")
      write_result(options.json ? failed_json(command, version, error, exit_number(error.kind()))
                                : "FAILED\n");
    throw;
  }
}

ExitStatus run_command(const Options& options, Console& console) {
  using Judged = counterflex::Command;
  switch (options.command) {
    case Command::compensate:
      return judged(Judged::compensate, run_compensate, options, console);
    case Command::predict:
      return judged(Judged::predict, run_predict, options, console);
    case Command::verify:
      return judged(Judged::verify, run_verify, options, console);
    case Command::compare:
      return run_compare(options, console);
    case Command::analyze:
      return run_analyze(options, console);
    case Command::forces:
      return run_forces(options, console);
    case Command::check:
      return run_check(options, console);
    case Command::create:
      return run_new(options, console);
    case Command::map:
      return run_map(options, console);
    case Command::identify:
      return run_identify(options, console);
    case Command::testcut:
      return run_testcut(options, console);
    case Command::import:
      return run_import(options, console);
    case Command::batch:
      return run_batch(options, console);
    case Command::watch:
      return run_watch(options, console);
  }
  return ExitStatus(ErrorKind::internal);
}

ExitStatus run(int argc, const char* const* argv) {
  Console plain;
  return guarded(plain, [&]() -> ExitStatus {
    const auto command_line = read_command_line(argc, argv);
    if (const auto* ended = std::get_if<std::optional<ErrorKind>>(&command_line)) return *ended;
    const Options& options = std::get<Options>(command_line);
    Console console({options.quiet, options.verbose});
    for (const SettingRemark& remark : options.remarks)
      console.warning(remark.where.file, remark.where.line, remark.what);
    if (!options.project_file.empty()) console.detail("project file " + options.project_file);
    return guarded(console, [&] { return run_command(options, console); });
  });
}

/// Keeps freed memory for the next window. Memory returned to the system would have to be cleared again.
void keep_freed_memory() {
#ifdef M_TRIM_THRESHOLD
  constexpr int trimmed_from = 256 << 20, mapped_from = 32 << 20;  // bytes
  mallopt(M_TRIM_THRESHOLD, trimmed_from);
  mallopt(M_MMAP_THRESHOLD, mapped_from);
#endif
}

}  // namespace
}  // namespace counterflex::cli

int main(int argc, char** argv) {
  const std::vector<const char*> arguments = counterflex::cli::begin_process(argc, argv);
  counterflex::cli::end_on_signals();
  counterflex::cli::keep_freed_memory();
  return counterflex::cli::run(static_cast<int>(arguments.size()), arguments.data()).number();
}
