/// Every file of tests/bad/settings says in its first line, behind "# expect: ", which diagnostic it must
/// cause, without the name of the file. Names that begin with "jobs" are jobs files, others project files.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/settings/jobs_file.hpp"
#include "counterflex/settings/project_file.hpp"

using namespace counterflex;

namespace {

std::vector<std::filesystem::path> bad_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(COUNTERFLEX_SOURCE_DIR "/tests/bad/settings"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string diagnostic_of(const std::string& text, const std::string& file) {
  try {
    if (file.starts_with("jobs"))
      read_jobs(text, file);
    else
      read_project(text, file);
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::machine_or_force);
    CHECK(error.where().file == file);
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a bad project or jobs file causes exactly the diagnostic that its first line expects") {
  const auto files = bad_files();
  REQUIRE(files.size() >= 30);
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

TEST_CASE("a file that breaks off anywhere is read or refused, with a place in it") {
  const std::string text =
      "format = \"counterflex-jobs 1\"\noutput = \"out\"\nforce = [[1, 2.5, 3], \"T1=1,2,3\"]\nreport = "
      "true\n"
      "[work.G54]\nxyz_mm = [1, 2, 3]\n[tools.T1]\nlength_mm = 5\n[[job]]\nprogram = [\"a\", \"b\"]\n";
  REQUIRE(diagnostic_of(text, "jobs.toml") == "none");
  std::size_t refused = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    CAPTURE(length);
    refused += diagnostic_of(text.substr(0, length), "jobs.toml") != "none";
  }
  CHECK(refused >= text.size() - 2);
}
