#include "run/compensate.hpp"

#include "commands/commands.hpp"
#include "run/output_paths.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {

std::optional<ErrorKind> run_compensate(const Options& options, Console& console) {
  return replacing(output_paths(options), console, [&] {
    return compensate_program(options, console,
                              [&](const Run& run, const RunEnd& end, const RunFiles& files) {
                                return tell_result(options, run, end, files, console);
                              });
  });
}

}  // namespace counterflex::cli
