#pragma once
/// Folders, and names in them that survive a power cut.
#include <string>

namespace counterflex {

/// That of the file `path`; "." for a name alone.
std::string folder_of(const std::string& path);

/// Makes `path` and what is missing above it. Throws `InputError` (Exit::transient_io) naming the folder that
/// cannot be made.
void make_folder(const std::string& path);

/// Brings the names of files in `folder` to the disk. Where a file system or the folder's rights do not allow
/// that, the files are there all the same. Throws `InputError` (Exit::transient_io) where the disk fails.
void sync_folder(const std::string& folder);

}  // namespace counterflex
