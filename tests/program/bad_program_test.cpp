#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/program/read_program.hpp"

using namespace counterflex;

namespace {

std::vector<std::filesystem::path> bad_programs() {
  std::vector<std::filesystem::path> paths;
  const std::filesystem::path folder = std::filesystem::path(COUNTERFLEX_SOURCE_DIR) / "tests/bad/program";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Text of the comment "(expect: ...)" in the first line.
std::string expectation(const std::string& text) {
  const std::string mark = "(expect: ";
  const std::size_t begin = text.find(mark);
  const std::size_t end = text.find(')', begin);
  const std::size_t line_end = text.find('\n');
  if (begin >= line_end || end >= line_end) return "no expectation on the first line";
  return text.substr(begin + mark.size(), end - begin - mark.size());
}

/// The dialect of the comment "(dialect: ...)" in the first line; else auto.
ReadOptions options_of(const std::string& text) {
  ReadOptions options;
  const std::string line = text.substr(0, text.find('\n')), mark = "(dialect: ";
  if (const std::size_t at = line.find(mark); at != std::string::npos)
    options.dialect = line.substr(at + mark.size(), line.find(')', at) - at - mark.size());
  return options;
}

std::string diagnostic(const std::string& text) {
  try {
    read_program(text, "", options_of(text));
  } catch (const InputError& error) {
    const Location& where = error.where();
    return std::to_string(where.line) + ":" + std::to_string(where.column) + ": " + error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("every bad program is refused with its exact diagnostic") {
  const auto paths = bad_programs();
  CHECK(paths.size() >= 40);
  for (const auto& path : paths) {
    CAPTURE(path.filename().string());
    const std::string text = read_file(path.string());
    CHECK(diagnostic(text) == expectation(text));
  }
}
