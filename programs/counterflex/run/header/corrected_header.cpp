#include "run/header/corrected_header.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

/// The first bytes of a file, enough for a header; empty if it cannot be read. In a Yaskawa job the header
/// is behind the list of all positions.
std::string beginning_of(const std::string& path) {
  constexpr std::size_t enough = 1 << 14;
  std::string bytes;
  try {
    FileReader file(path);
    file.append(bytes, enough);
    if (!bytes.starts_with("/JOB")) return bytes;
    std::size_t searched = 0;
    while (bytes.find("//INST", searched) == std::string::npos) {
      searched = bytes.size() - std::min<std::size_t>(bytes.size(), 6);
      if (file.append(bytes, enough) == 0) break;
    }
    file.append(bytes, enough);
  } catch (const InputError&) {
    return {};
  }
  return bytes;
}

/// The digits of the hashes in the lines "COUNTERFLEX 1 KEY HASH" of a header, in lower case.
std::vector<std::string> digits_of(const std::string& header, std::string_view key) {
  constexpr std::size_t least = 10, most = 16;  // remarks of FANUC have room for 10
  const std::string mark = "COUNTERFLEX 1 " + std::string(key) + ' ';
  std::vector<std::string> all;
  for (std::size_t at = 0; (at = header.find(mark, at)) != std::string::npos;) {
    at += mark.size();
    std::string digits = header.substr(at, most);
    const auto end = std::ranges::find_if_not(digits, [](unsigned char c) { return std::isxdigit(c) != 0; });
    digits.erase(end, digits.end());
    if (digits.size() < least) continue;
    for (char& c : digits) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    all.push_back(std::move(digits));
  }
  return all;
}

/// Of the original program; empty if the file has no header.
std::vector<std::string> program_digits(const std::string& header) {
  return digits_of(header, "PROGRAM");
}

/// "NAME_12", as parts are named.
bool is_name_of_part(const std::string& stem) {
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  return digits > 1 && digits < stem.size() && stem[digits - 1] == '_';
}

/// Whether the name is in the text of the file, not as the begin of a longer one. ABB calls run_NAME.
bool names(const std::string& path, const std::string& name) {
  constexpr std::size_t at_once = 1 << 20;
  std::string text;
  FileReader file(path);
  while (file.append(text, at_once) > 0) {
  }
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
    at += name.size();
    const char next = at < text.size() ? text[at] : ' ';
    if (std::isalnum(static_cast<unsigned char>(next)) == 0 && next != '_') return true;
  }
  return false;
}

}  // namespace

bool has_corrected_header(const std::string& path) {
  return !program_digits(beginning_of(path)).empty();
}

bool are_of_one_program(const std::string& a, const std::string& b) {
  const std::vector<std::string> digits = program_digits(beginning_of(a));
  return !digits.empty() && digits == program_digits(beginning_of(b));
}

std::string divided_program_of(const std::string& part) {
  namespace fs = std::filesystem;
  const fs::path path(part);
  const std::string name = path.stem().generic_string();
  if (!is_name_of_part(name) || !has_corrected_header(part)) return {};
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path other = path.parent_path() / entry->path().filename();
    const std::string other_name = other.stem().generic_string();
    const bool is_own_part = other_name.starts_with(name + "_");
    if (other.extension() != path.extension() || other_name == name || is_own_part) continue;
    const std::string program = other.generic_string();
    if (are_of_one_program(part, program) && names(program, name)) return program;
  }
  return {};
}

}  // namespace counterflex::cli
