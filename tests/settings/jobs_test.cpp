#include <doctest/doctest.h>

#include "counterflex/settings/jobs_file.hpp"
#include "setting_texts.hpp"

using namespace counterflex;

namespace {

JobsFile jobs_with(const std::string& lines, const std::string& file = "jobs.toml") {
  return read_jobs("format = \"counterflex-jobs 1\"\n" + lines, file);
}

}  // namespace

TEST_CASE("a jobs file has defaults for all jobs, and jobs with programs and settings of their own") {
  const JobsFile jobs = jobs_with(
      "output = \"corrected\"\nmachine = \"m.toml\"\ntolerance_mm = 0.01\n"
      "[[job]]\nprogram = \"parts/*.ngc\"\n"
      "[[job]]\nprogram = [\"a.nc\", \"/tmp/b.nc\"]\ntolerance_mm = 0.002\nforces = \"f.csv\"\n",
      "night/jobs.toml");
  CHECK(jobs.output == "night/corrected");
  CHECK(test::value(jobs.defaults, "output") == "night/corrected/");
  CHECK(test::value(jobs.defaults, "machine") == "night/m.toml");
  REQUIRE(jobs.jobs.size() == 2);
  CHECK(jobs.jobs[0].programs == std::vector<std::string>{"night/parts/*.ngc"});
  CHECK(jobs.jobs[0].settings.empty());
  CHECK(jobs.jobs[0].where.line == 5);
  CHECK(jobs.jobs[1].programs == std::vector<std::string>{"night/a.nc", "/tmp/b.nc"});
  CHECK(test::value(jobs.jobs[1].settings, "tolerance-mm") == "0.002");
  CHECK(test::value(jobs.jobs[1].settings, "forces") == "night/f.csv");
}

TEST_CASE(
    "an output of a jobs file without a pattern is a folder, and a name without a folder is in that of the "
    "batch") {
  const JobsFile jobs = jobs_with(
      "output = \"out/{name}_CF{ext}\"\n[[job]]\nprogram = \"a\"\noutput = \"left\"\n"
      "[[job]]\nprogram = \"b\"\noutput = \"right/\"\n[[job]]\nprogram = \"c\"\noutput = \"{name}2{ext}\"\n");
  CHECK(jobs.output == "out");
  CHECK(test::value(jobs.defaults, "output") == "out/{name}_CF{ext}");
  CHECK(test::value(jobs.jobs[0].settings, "output") == "left/");
  CHECK(test::value(jobs.jobs[1].settings, "output") == "right/");
  CHECK(test::value(jobs.jobs[2].settings, "output") == "out/{name}2{ext}");
}

TEST_CASE("an absolute folder of results is not changed") {
  CHECK(jobs_with("output = \"/tmp/out\"\n[[job]]\nprogram = \"a\"\n", "night/jobs.toml").output ==
        "/tmp/out");
}

TEST_CASE("braces in the folder of a jobs file are literal") {
  const JobsFile jobs = jobs_with(
      "output = \"out\"\nreport = \"r/{name}\"\n[[job]]\nprogram = \"a\"\noutput = \"left/{name}2{ext}\"\n",
      "proj{x}/jobs.toml");
  CHECK(jobs.output == "proj{x}/out");
  CHECK(jobs.jobs[0].programs == std::vector<std::string>{"proj{x}/a"});
  CHECK(fill(test::value(jobs.defaults, "output"), {}) == "proj{x}/out/");
  CHECK(fill(test::value(jobs.defaults, "report"), {"n", {}, {}}) == "proj{x}/r/n");
  CHECK(fill(test::value(jobs.jobs[0].settings, "output"), {"n", ".e", {}}) == "proj{x}/left/n2.e");
}
