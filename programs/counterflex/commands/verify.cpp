#include "run/verify.hpp"

#include <filesystem>
#include <utility>

#include "commands/commands.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {
namespace {

/// The data lists of the corrected program: files of the same names beside it, or those of the original that
/// were not changed and so not written.
std::vector<std::string> lists_beside_corrected(const Options& options) {
  std::vector<std::string> lists;
  for (const std::string& list : options.data_lists) {
    const std::string corrected = corrected_list(list, options.program, options.verify.corrected);
    std::error_code ignored;
    lists.push_back(std::filesystem::exists(corrected, ignored) ? corrected : list);
  }
  return lists;
}

}  // namespace

std::optional<ErrorKind> run_verify(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths);
  return replacing(paths, console, [&] {
    const auto run = prepare_run(options, console);
    ProgramFile corrected =
        open_program("corrected", options.verify.corrected, lists_beside_corrected(options), console);
    return verify_run(options, *run, std::move(corrected), paths, console,
                      [&](const Run& finished, const RunEnd& end, const RunFiles& files) {
                        return tell_result(options, finished, end, files, console);
                      });
  });
}

}  // namespace counterflex::cli
