#pragma once
/// Reads files that a command line names.
#include <string>

#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {

/// What `read` gives. If the file cannot be read, the kind of the error is `unreadable`, unless it may be
/// read another time.
template <typename Read>
auto or_unreadable(ErrorKind unreadable, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    if (error.kind() == unreadable || error.kind() == ErrorKind::transient_io) throw;
    const std::string what = error.what();
    const std::size_t at = what.find("cannot read");
    throw InputError(unreadable, error.where(), at == std::string::npos ? what : what.substr(at));
  }
}

/// A file's bytes. Throws `InputError` of the kind `unreadable` if they cannot be read.
std::string read_input(const std::string& path, ErrorKind unreadable);

/// Throws `InputError` of the kind `unreadable` where `path` is a folder.
void refuse_folder(const std::string& path, ErrorKind unreadable);

/// Whether two paths are one file. If one of them does not exist, compares the names.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace counterflex::cli
