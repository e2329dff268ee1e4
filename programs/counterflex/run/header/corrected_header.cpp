#include "run/header/corrected_header.hpp"

#include <algorithm>
#include <cctype>

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

}  // namespace

bool has_corrected_header(const std::string& path) {
  return !program_digits(beginning_of(path)).empty();
}

bool are_of_one_program(const std::string& a, const std::string& b) {
  const std::vector<std::string> digits = program_digits(beginning_of(a));
  return !digits.empty() && digits == program_digits(beginning_of(b));
}

bool is_corrected_from(const std::string& output, const std::vector<std::string>& files) {
  const std::string header = beginning_of(output);
  std::vector<std::string> digits = program_digits(header);
  const std::vector<std::string> lists = digits_of(header, "DATA LIST");
  if (digits.empty()) return false;
  digits.resize(1);
  digits.insert(digits.end(), lists.begin(), lists.end());
  if (digits.size() != files.size()) return false;
  try {
    for (std::size_t i = 0; i < files.size(); ++i) {
      FileReader bytes(files[i]);
      if (!sha256(bytes).starts_with(digits[i])) return false;
    }
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace counterflex::cli
