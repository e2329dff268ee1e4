#include "counterflex/files/input_error.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace counterflex;

TEST_CASE("a diagnostic has the known part of the place") {
  const auto text = [](const Location& where) {
    return std::string(InputError(ErrorKind::usage, where, "m").what());
  };
  CHECK(text({"a.ngc", 3, 7}) == "a.ngc:3:7: error: m");
  CHECK(text({"a.ngc", 3, 0}) == "a.ngc:3: error: m");
  CHECK(text({"a.ngc", 0, 0}) == "a.ngc: error: m");
  CHECK(text({}) == "error: m");
}

TEST_CASE("an input error keeps its exit status and its place") {
  const InputError error(ErrorKind::program_text, {"a.ngc", 3, 7}, "m");
  CHECK(error.kind() == ErrorKind::program_text);
  CHECK(error.where().line == 3);
  CHECK(error.where().column == 7);
}
