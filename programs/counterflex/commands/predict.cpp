#include "run/predict.hpp"

#include "commands/commands.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {

std::optional<ErrorKind> run_predict(const Options& options, Console& console) {
  if (options.predict.offsets && options.free_spin)
    throw InputError(
        ErrorKind::usage, {},
        "--offsets keeps the program, and --free spin changes its targets; leave one of them out");
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths);
  return replacing(paths, console, [&] {
    return predict_run(options, *prepare_run(options, console), paths, console,
                       [&](const Run& run, const RunEnd& end, const RunFiles& files) {
                         return tell_result(options, run, end, files, console);
                       });
  });
}

}  // namespace counterflex::cli
