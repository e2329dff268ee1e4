#pragma once
/// Real robot programs of a folder that the environment names.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "counterflex/files/files.hpp"
#include "program/robot/edits.hpp"

namespace counterflex::test {

/// Each program of COUNTERFLEX_PROGRAMS that `is_wanted` has to be written back byte for byte, or to be
/// refused with line and column. Says that it is skipped if the variable is not set.
inline void check_corpus(const std::function<bool(const std::filesystem::path&)>& is_wanted,
                         const std::function<std::string(const std::filesystem::path&)>& text_of,
                         const ReadOptions& options = {}) {
  const char* folder = std::getenv("COUNTERFLEX_PROGRAMS");
  if (folder == nullptr) {
    std::puts("skipped: the environment variable COUNTERFLEX_PROGRAMS does not name a folder of programs");
    return;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_wanted(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    const std::string text = text_of(entry.path());
    try {
      const Program program = read_program(text, name, options);
      CHECK(!program.moves.empty());
      CHECK(unchanged(program) == text);
      MESSAGE(name << ": " << program.moves.size() << " moves, " << program.left_alone.size()
                   << " left alone");
    } catch (const InputError& error) {
      MESSAGE(std::string(error.what()));
      CHECK(error.where().line > 0);
      CHECK(error.where().column > 0);
    }
  }
}

inline std::string text_of_file(const std::filesystem::path& path) {
  return read_file(path.string());
}

}  // namespace counterflex::test
