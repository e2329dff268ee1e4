#pragma once
/// A part of a program, compensated by a process of its own, and what a later run takes over of it.
#include <functional>
#include <string>
#include <vector>

#include "console.hpp"
#include "run.hpp"

namespace counterflex::cli {

/// The same for two runs whose windows are compensated alike, to the last bit: a digest of version, options
/// and inputs. The header of `run.options` has to be set.
std::string digest_of(const Run& run);

/// Compensates the windows that begin in `options.part` and writes its file of records; nothing else is
/// written, whatever `options` says of outputs. A window that cannot be compensated ends the records, and is
/// left with its error to the run that takes them over: that is no failure here. `tell` hears when the file
/// has its name. Throws `InputError` as `prepare_run`, and where the file cannot be written.
Exit record_part(const Options& options, Console& console, const std::function<void(const Run&)>& tell);

}  // namespace counterflex::cli
