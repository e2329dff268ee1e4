/// The first line of every file of tests/bad/settings has, after "# expect: ", the diagnostic that it must
/// cause, without the name of the file. Names that begin with "jobs" are jobs files, others project files.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/settings/jobs_file.hpp"
#include "counterflex/settings/project_file.hpp"
#include "support/bad_files.hpp"

using namespace counterflex;

namespace {

void read_either(const std::string& text, const std::string& file) {
  if (file.starts_with("jobs"))
    read_jobs(text, file);
  else
    read_project(text, file);
}

}  // namespace

TEST_CASE("a bad project or jobs file causes exactly the diagnostic that its first line expects") {
  check_bad_files("settings", 30, read_either);
}

TEST_CASE("a truncated file is read, or refused with a place in it") {
  const std::string text =
      "format = \"counterflex-jobs 1\"\noutput = \"out\"\nforce = [[1, 2.5, 3], \"T1=1,2,3\"]\nreport = "
      "true\n"
      "[work.G54]\nxyz_mm = [1, 2, 3]\n[tools.T1]\nlength_mm = 5\n[[job]]\nprogram = [\"a\", \"b\"]\n";
  REQUIRE(diagnostic_of(read_jobs, text, "jobs.toml") == "none");
  std::size_t refused = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    CAPTURE(length);
    refused += diagnostic_of(read_jobs, text.substr(0, length), "jobs.toml") != "none";
  }
  CHECK(refused >= text.size() - 2);
}
