#include "run/header/header_hashes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

#include "run/header/header.hpp"

namespace counterflex::cli {
namespace {

constexpr std::size_t least_digits = 8;

/// The last word of at least eight hexadecimal digits, in lower case; empty without such a word.
std::string hash_in(const std::string& line) {
  std::string found;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    while (!word.empty() && (word.back() == ')' || word.back() == '\r')) word.pop_back();
    std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
    if (word.size() >= least_digits && word.find_first_not_of("0123456789abcdef") == std::string::npos)
      found = word;
  }
  return found;
}

/// Hashes in the lines of the header that begin with `key`.
std::vector<std::string> hashes_of(const std::string& text, const std::string& key) {
  std::vector<std::string> hashes;
  const std::string begin = "COUNTERFLEX 1 " + key + " ";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    std::string hash = hash_in(text.substr(at + begin.size(), text.find('\n', at) - at - begin.size()));
    if (!hash.empty()) hashes.push_back(std::move(hash));
  }
  return hashes;
}

bool is_hash_of(const std::string& hash, const InputFile& file) {
  return file.sha256.starts_with(hash);
}

std::string warning(const std::string& what, const std::string& hash, const std::string& given) {
  return fmt::format("made for {} (SHA-256 {}...) than {}", what, hash.substr(0, 12), given);
}

std::string given(const std::string& name, const InputFile& file) {
  return fmt::format("{} (SHA-256 {}...)", name, file.sha256.substr(0, 12));
}

constexpr std::string_view line_begin = "COUNTERFLEX 1 ";

/// Of `lines` those that begin with `key`, joined.
std::string lines_with(std::string_view key, const std::vector<std::string>& lines) {
  std::string found;
  for (const std::string& line : lines)
    if (line.starts_with(key)) found += (found.empty() ? "" : "; ") + line;
  return found;
}

/// The lines of a header without their marks.
std::vector<std::string> header_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = text.find(line_begin); at != std::string::npos; at = text.find(line_begin, at)) {
    at += line_begin.size();
    std::string line = text.substr(at, text.find('\n', at) - at);
    line.resize(line.find_last_not_of(" \r);") + 1);
    lines.push_back(std::move(line));
  }
  return lines;
}

constexpr std::array<std::string_view, 8> statements{"WORK ",
                                                     "TEMPERATURE ",
                                                     "TOOL ",
                                                     "FORCE ",
                                                     "NO CUTTING FORCE",
                                                     "WITH FORCES TIMES ",
                                                     "WITH FORCES BLENDED ",
                                                     "NO FORCE ABOVE "};

std::string without_blanks(const std::string& text) {
  std::string rest;
  std::ranges::copy_if(text, std::back_inserter(rest), [](char c) { return c != ' '; });
  return rest;
}

/// A FANUC divides lines among remarks: their beginnings are lost.
void add_statements_of_remarks(const std::vector<std::string>& found, const std::vector<std::string>& own,
                               std::vector<std::string>& warnings) {
  std::string joined;
  for (const std::string& line : found) joined += without_blanks(line);
  for (const std::string& line : own) {
    const auto begins = [&](std::string_view key) { return line.starts_with(key); };
    if (std::ranges::any_of(statements, begins) && joined.find(without_blanks(line)) == std::string::npos)
      warnings.push_back(
          fmt::format("made for other conditions than those of this run, which is for '{}'", line));
  }
}

/// What the header states of work offsets, tools, forces and the temperature, and this run differently.
void add_other_statements(const std::string& text, const Options& options, const Run& run,
                          std::vector<std::string>& warnings) {
  const std::vector<std::string> found = header_lines(text);
  std::vector<std::string> own = header_of(options, run);
  for (std::string& line : own) line.erase(0, line_begin.size());
  if (run.program.dialect == "fanuc_tp") return add_statements_of_remarks(found, own, warnings);
  for (const std::string_view key : statements) {
    const std::string was = lines_with(key, found), is = lines_with(key, own);
    if (was == is) continue;
    warnings.push_back(
        fmt::format("made for other conditions than those of this run: its header has {}, this run {}",
                    was.empty() ? "no such line" : "'" + was + "'",
                    is.empty() ? "has no such line" : "is for '" + is + "'"));
  }
}

/// Options with which the original was read according to the header, if they differ from those of this run.
std::string other_reading(const std::string& text, const ReadOptions& read) {
  const std::string begin = "COUNTERFLEX 1 READ WITH ";
  const std::size_t at = text.find(begin), end = text.find('\n', at);
  const std::string in_header =
      at == std::string::npos ? "" : text.substr(at + begin.size(), end - at - begin.size());
  std::string missing, more;
  for (const ReadingWord& word : reading_words(read)) {
    const bool was = in_header.find(word.in_header) != std::string::npos;
    std::string& list = was ? missing : more;
    if (was != word.acts) list += fmt::format("{}{}", list.empty() ? "" : " ", word.option);
  }
  if (missing.empty() && more.empty()) return {};
  std::string words = "the original was read with other options when this program was made:";
  if (!missing.empty()) words += fmt::format(" give {} here, too", missing);
  if (!more.empty()) words += fmt::format("{} leave out {}", missing.empty() ? "" : ", and", more);
  return words;
}

}  // namespace

std::vector<std::string> other_inputs_of_header(const std::string& text, const Options& options,
                                                const Run& run) {
  std::vector<std::string> warnings;
  for (const std::string& hash : hashes_of(text, "MACHINE"))
    if (!is_hash_of(hash, run.machine.file))
      warnings.push_back(
          warning("another machine file", hash, given(run.machine.file.path, run.machine.file)));
  const auto& lists = run.file.data_lists;
  for (const std::string& hash : hashes_of(text, "DATA LIST"))
    if (std::ranges::none_of(lists, [&](const InputFile& file) { return is_hash_of(hash, file); }))
      warnings.push_back(warning(
          "another data list", hash,
          lists.empty() ? "this run, which has no data list" : given(lists.front().path, lists.front())));
  const auto& forces = run.force_input.files;
  for (const std::string& hash : hashes_of(text, "FORCES"))
    if (std::ranges::none_of(forces, [&](const InputFile& file) { return is_hash_of(hash, file); }))
      warnings.push_back(warning(
          "another force file", hash,
          forces.empty() ? "this run, which has no force file" : given(forces.front().path, forces.front())));
  for (const std::string& hash : hashes_of(text, "TOOLS"))
    if (!run.tools.file || !is_hash_of(hash, *run.tools.file))
      warnings.push_back(warning("another tool table", hash,
                                 run.tools.file ? given(run.tools.file->path, *run.tools.file)
                                                : "this run, which has no tool table"));
  const bool has_header = text.find("COUNTERFLEX 1 VERSION") != std::string::npos;
  if (has_header) add_other_statements(text, options, run, warnings);
  if (std::string reading = has_header ? other_reading(text, run.read) : ""; !reading.empty())
    warnings.push_back(std::move(reading));
  if (text.find("COUNTERFLEX 1 " + std::string(only_significant_mark)) != std::string::npos &&
      !run.options.only_significant)
    warnings.emplace_back("targets below their bands stay as programmed: give --only-significant here, too");
  return warnings;
}

}  // namespace counterflex::cli
