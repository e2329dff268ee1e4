#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "counterflex/files/files.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE(
    "every program of a folder of real programs is refused with a position or is reproduced byte for byte") {
  const char* folder = std::getenv("COUNTERFLEX_PROGRAMS");
  if (folder == nullptr) {
    std::puts(
        "skipped: the environment variable COUNTERFLEX_PROGRAMS does not name a folder of programs");  // for
                                                                                                       // ctest
    return;
  }
  int read_back = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    CAPTURE(entry.path().filename().string());
    const std::string text = read_file(entry.path().string());
    try {
      const Program program = read_program(text, entry.path().filename().string(), {});
      CHECK(rewrite(program, edits_to_original(program), {}).text == text);
      ++read_back;
    } catch (const InputError& error) {
      MESSAGE(std::string(error.what()));
      CHECK(error.where().line > 0);
      CHECK(error.where().column > 0);
    }
  }
  CHECK(read_back > 0);
}
