#pragma once
/// What a run writes, and where it may.
#include <string>
#include <string_view>
#include <vector>

#include "options.hpp"

namespace counterflex::cli {

/// Where a run writes to; an empty path is not written.
struct OutputPaths {
  std::string program;  ///< "-": standard output
  std::string report_json;
  std::string report_csv;
};

/// The paths of `options`, the program's among them for `compensate`: NAME.comp.EXT beside the input unless
/// given, standard output for standard input. Throws `InputError`: Exit::usage where a path is that of an
/// input, by whatever name, where two are the same, or where the program and --json both want standard
/// output; Exit::transient_io where its folder does not exist.
OutputPaths output_paths(const Options& options);

/// "part.ngc" gives "part.comp.ngc".
std::string default_output(const std::string& program);

struct OutputFile {
  std::string path;
  std::string bytes;
};

/// Writes all files that have a path, each completely or not at all, deaf to interrupts meanwhile; standard
/// output last.
void write_files(const std::vector<OutputFile>& files);

/// Text on standard output. Throws `InputError` (Exit::transient_io).
void write_result(std::string_view text);

}  // namespace counterflex::cli
