#pragma once
/// Whole files in, whole files out.
#include <string>
#include <string_view>

namespace counterflex {

/// The bytes of a file; "-" is standard input. Throws as `FileReader` where it cannot be read.
std::string read_file(const std::string& path);

/// Writes `bytes` under `path` or not at all: to a temporary name in the same folder, flushed, then renamed. "-" is
/// standard output. Throws `InputError` (Exit::transient_io) naming the path, and leaves no temporary file.
void write_file(const std::string& path, std::string_view bytes);

/// SHA-256 of `bytes`, 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "sha256-" and the digest in base64: how a page's security policy names what it allows.
std::string integrity(std::string_view bytes);

}  // namespace counterflex
