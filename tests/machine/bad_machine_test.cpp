/// The first line of every file of tests/bad/machine has, after "# expect: ", the diagnostic that it must
/// cause, without the name of the file.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "support/bad_files.hpp"

using namespace counterflex;

TEST_CASE("a bad machine file causes exactly the diagnostic that its first line expects") {
  check_bad_files("machine", 100, read_machine);
}

TEST_CASE("a machine file that cannot be read is an input error that names it") {
  try {
    load_machine("no/such/machine.toml");
    FAIL("it was read");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find("no/such/machine.toml") != std::string::npos);
  }
}

TEST_CASE("columns count bytes, also after characters of more than one byte, CRLF and a byte order mark") {
  const std::string head =
      "\xEF\xBB\xBF"
      "format = \"counterflex-machine 1\"\r\n";
  CHECK(diagnostic_of(
            read_machine,
            head + "name = \"\xC3\xA4\xE2\x82\xAC\" # \xF0\x9F\x98\x80\r\nlimits = { \"\xC3\xA4\" = 1 }\r\n",
            "m.toml")
            .starts_with("m.toml:3:12: error: unknown key"));
  CHECK(diagnostic_of(read_machine, head + "springs = { \"\xE2\x82\xAC\xC3\xA4\" = 5 }\r\n", "m.toml")
            .starts_with("m.toml:2:23: error:"));
}
