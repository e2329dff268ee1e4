/// Every file of tests/bad/machine says in its first line, behind "# expect: ", which diagnostic it must
/// cause, without the name of the file.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

namespace {

const std::filesystem::path folder = COUNTERFLEX_SOURCE_DIR "/tests/bad/machine";

std::vector<std::filesystem::path> bad_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string diagnostic_of(const std::string& text, const std::string& file) {
  try {
    read_machine(text, file);
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::machine_or_force);
    CHECK(error.where().file == file);
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a bad machine file causes exactly the diagnostic that its first line expects") {
  const auto files = bad_files();
  REQUIRE(files.size() >= 100);
  for (const auto& path : files) {
    const std::string name = path.filename().string();
    CAPTURE(name);
    const std::string text = read_file(path.string());
    const std::string mark = "# expect: ";
    REQUIRE(text.starts_with(mark));
    const std::string expected = text.substr(mark.size(), text.find('\n') - mark.size());
    CHECK(diagnostic_of(text, name) == name + ":" + expected);
  }
}

TEST_CASE("a machine file that cannot be read is an input error that names it") {
  try {
    load_machine("no/such/machine.toml");
    FAIL("it was read");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find("no/such/machine.toml") != std::string::npos);
  }
}

TEST_CASE("columns count bytes, also behind characters of more than one byte, CRLF and a byte order mark") {
  const std::string head =
      "\xEF\xBB\xBF"
      "format = \"counterflex-machine 1\"\r\n";
  CHECK(diagnostic_of(
            head + "name = \"\xC3\xA4\xE2\x82\xAC\" # \xF0\x9F\x98\x80\r\nlimits = { \"\xC3\xA4\" = 1 }\r\n",
            "m.toml")
            .starts_with("m.toml:3:12: error: unknown key"));
  CHECK(diagnostic_of(head + "springs = { \"\xE2\x82\xAC\xC3\xA4\" = 5 }\r\n", "m.toml")
            .starts_with("m.toml:2:23: error:"));
}
