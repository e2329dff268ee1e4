#pragma once
/// Reads files that a command line names.
#include <string>

#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {

/// What `read` gives; a file that cannot be read has the exit status `unreadable`, unless it may be read
/// another time.
template <typename Read>
auto or_unreadable(Exit unreadable, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    if (error.exit() == unreadable || error.exit() == Exit::transient_io) throw;
    const std::string what = error.what();
    const std::size_t at = what.find("cannot read");
    throw InputError(unreadable, error.where(), at == std::string::npos ? what : what.substr(at));
  }
}

/// A file's bytes. Unreadable: exit status `unreadable`.
std::string read_input(const std::string& path, Exit unreadable);

/// Throws `InputError` with exit status `unreadable` where `path` is a folder.
void refuse_folder(const std::string& path, Exit unreadable);

}  // namespace counterflex::cli
