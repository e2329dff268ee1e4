#pragma once
/// The commands. Each returns the kind of its first error, or none. Throws `InputError` for errors of its
/// inputs, before any file is written.
#include <optional>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"
#include "process/exit_status.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

std::optional<ErrorKind> run_compensate(const Options& options, Console& console);
std::optional<ErrorKind> run_predict(const Options& options, Console& console);
std::optional<ErrorKind> run_verify(const Options& options, Console& console);
std::optional<ErrorKind> run_compare(const Options& options, Console& console);
std::optional<ErrorKind> run_analyze(const Options& options, Console& console);
std::optional<ErrorKind> run_map(const Options& options, Console& console);
std::optional<ErrorKind> run_forces(const Options& options, Console& console);
std::optional<ErrorKind> run_identify(const Options& options, Console& console);
/// Writes a program of a test piece, half of it corrected, and the sheet for what is measured on it.
std::optional<ErrorKind> run_testcut(const Options& options, Console& console);
/// Writes a machine file from another description of the machine.
std::optional<ErrorKind> run_import(const Options& options, Console& console);
std::optional<ErrorKind> run_check(const Options& options, Console& console);
std::optional<ErrorKind> run_new(const Options& options, Console& console);

/// The exit status is that of a signal if one has stopped the batch.
ExitStatus run_batch(const Options& options, Console& console);

/// Compensates the programs that appear in a folder, until it is interrupted.
std::optional<ErrorKind> run_watch(const Options& options, Console& console);

}  // namespace counterflex::cli
