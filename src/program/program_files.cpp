#include "counterflex/program/program_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "program/program_files.hpp"
#include "program/robot/kuka/loops.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t portion_size = 1 << 18;

/// The line before a file. A newline before it ends the last line of the file before.
std::string line_before(const std::string& path) {
  return fmt::format("\n{}{}\n", file_mark, fs::path(path).filename().generic_string());
}

/// Number of lines that a file ends. Refuses a file with a line that looks like the one between files.
int count_newlines(const std::string& path) {
  FileReader file(path);
  int count = 0;
  bool begins_line = true;
  for (std::string text; file.append(text, portion_size) > 0;) {
    for (std::size_t at = 0; at < text.size();) {
      const std::string_view rest = std::string_view(text).substr(at);
      if (begins_line && (rest.starts_with(file_mark) || rest.starts_with(back_mark)))
        throw InputError(
            ErrorKind::usage, {path, count + 1, 1},
            fmt::format("a line that begins with '{}' is not supported in programs with data lists",
                        rest.substr(0, file_mark.size())));
      const std::size_t newline = text.find('\n', at);
      begins_line = newline != std::string::npos;
      if (begins_line) ++count;
      at = begins_line ? newline + 1 : text.size();
    }
    text.clear();
  }
  return count;
}

}  // namespace

bool takes_data_lists(const std::string& program) {
  return is_word(fs::path(program).extension().generic_string(), ".SRC");
}

std::string data_list_beside(const std::string& program) {
  const fs::path path(program);
  if (!takes_data_lists(program)) return {};
  for (const char* extension : {".dat", ".DAT", ".Dat"}) {
    const fs::path list = fs::path(path).replace_extension(extension);
    std::error_code ignored;
    if (fs::is_regular_file(list, ignored)) return list.generic_string();
  }
  return {};
}

FileReader join_files(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return FileReader(paths[0]);
  std::vector<FileReader> parts;
  for (const std::string& path : paths) {
    if (!parts.empty()) parts.push_back(FileReader::of_bytes(line_before(path)));
    parts.emplace_back(path);
  }
  return FileReader::joined(std::move(parts));
}

std::optional<FileReader> join_files_by_motion(const std::vector<std::string>& paths) {
  constexpr std::size_t largest_program = 200'000;  // bytes: the first portion of a reader has all of it
  if (paths.size() != 2) return std::nullopt;
  std::string program;
  FileReader file(paths[0]);
  while (program.size() <= largest_program && file.append(program, portion_size) > 0) {
  }
  if (program.size() > largest_program) return std::nullopt;
  FileReader list(paths[1]);
  const auto cut = cut_behind_loop(program, list);
  if (!cut) return std::nullopt;
  list.rewind();
  std::string before = line_before(paths[1]);
  before.insert(before.size() - 1, fmt::format("{}{}", line_mark, first_lines(paths)[1]));
  std::vector<FileReader> parts;
  parts.push_back(FileReader::of_bytes(program.substr(0, cut->at) + before));
  parts.push_back(std::move(list));
  parts.push_back(FileReader::of_bytes(fmt::format("\n{}{}{}\n", back_mark, line_mark, cut->line) +
                                       program.substr(cut->at)));
  return FileReader::joined(std::move(parts));
}

std::vector<int> first_lines(const std::vector<std::string>& paths) {
  std::vector<int> first{1};
  for (std::size_t i = 0; i + 1 < paths.size(); ++i)
    first.push_back(first.back() + count_newlines(paths[i]) + 2);
  if (paths.size() > 1) count_newlines(paths.back());
  return first;
}

Location place_in_files(const std::vector<std::string>& paths, const std::vector<int>& first, int line) {
  const auto behind = std::upper_bound(first.begin() + 1, first.end(), line);
  const auto file = static_cast<std::size_t>(behind - first.begin()) - 1;
  return {paths[file], line - first[file] + 1, 0};
}

FileSplitter::FileSplitter(std::function<void(std::size_t, std::string_view)> write)
    : write_(std::move(write)) {}

void FileSplitter::write(std::string_view bytes) {
  if (bytes.empty()) return;
  if (holds_newline_) write_(file_, "\n");
  holds_newline_ = bytes.back() == '\n';
  write_(file_, bytes.substr(0, bytes.size() - (holds_newline_ ? 1 : 0)));
}

void FileSplitter::finish() {
  if (holds_newline_) write_(file_, "\n");
}

void FileSplitter::add(std::string_view lines) {
  const auto begins_file = [&](std::size_t at) {
    const std::string_view line = lines.substr(at);
    return line.starts_with(file_mark) || line.starts_with(back_mark);
  };
  for (std::size_t at = 0; at < lines.size();) {
    std::size_t mark = at;
    while (mark < lines.size() && !begins_file(mark))
      mark = std::min(lines.find('\n', mark), lines.size() - 1) + 1;
    write(lines.substr(at, mark - at));
    if (mark == lines.size()) return;
    file_ = lines.substr(mark).starts_with(back_mark) ? 0 : file_ + 1;
    holds_newline_ = false;
    at = std::min(lines.find('\n', mark), lines.size() - 1) + 1;
  }
}

}  // namespace counterflex
