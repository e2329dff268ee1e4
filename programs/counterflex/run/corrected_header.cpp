#include "run/corrected_header.hpp"

#include <algorithm>
#include <cctype>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

/// The first bytes of a file, enough for a header; empty if it cannot be read.
std::string beginning_of(const std::string& path) {
  constexpr std::size_t enough = 1 << 14;
  std::string bytes;
  try {
    FileReader(path).append(bytes, enough);
  } catch (const InputError&) {
    return {};
  }
  return bytes;
}

/// The digits of the original's hash in the header of a corrected program, in lower case; empty if the file
/// has no header.
std::string program_digits(const std::string& path) {
  constexpr std::size_t count = 16;
  constexpr std::string_view mark = "COUNTERFLEX 1 PROGRAM ";
  const std::string bytes = beginning_of(path);
  const std::size_t at = bytes.find(mark);
  if (at == std::string::npos) return {};
  std::string digits = bytes.substr(at + mark.size(), count);
  if (digits.size() != count ||
      !std::ranges::all_of(digits, [](unsigned char c) { return std::isxdigit(c) != 0; }))
    return {};
  for (char& c : digits) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return digits;
}

}  // namespace

bool has_corrected_header(const std::string& path) {
  return !program_digits(path).empty();
}

bool is_corrected_from(const std::string& output, const std::string& program) {
  const std::string digits = program_digits(output);
  if (digits.empty()) return false;
  try {
    FileReader bytes(program);
    return sha256(bytes).starts_with(digits);
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace counterflex::cli
