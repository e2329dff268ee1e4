#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "counterflex/batch/manifest.hpp"

namespace counterflex {
namespace {

JobOutcome job(const std::string& program, Exit exit, std::optional<double> after,
               std::optional<double> before = 1) {
  JobOutcome outcome;
  outcome.program = program;
  outcome.output = "out/" + program;
  outcome.exit = exit;
  outcome.before_mm = before;
  outcome.after_mm = after;
  if (exit == Exit::done) outcome.verdict = "OK";
  if (exit != Exit::done) outcome.error = program + ":1:1: error: \"no\", it said";
  return outcome;
}

std::vector<std::string> programs(const std::vector<JobOutcome>& outcomes) {
  std::vector<std::string> names;
  for (const JobOutcome& outcome : outcomes) names.push_back(outcome.program);
  return names;
}

}  // namespace

TEST_CASE("failed jobs come first, then those with the largest remaining deviation") {
  const std::vector<JobOutcome> jobs{job("small", Exit::done, 0.001),    job("none", Exit::done, {}, {}),
                                     job("large", Exit::done, 0.004),    job("b", Exit::program_text, {}, {}),
                                     job("equal", Exit::done, 0.001, 2), job("a", Exit::limit, {}, {})};
  CHECK(programs(worst_first(jobs)) == std::vector<std::string>{"a", "b", "large", "equal", "small", "none"});
}

TEST_CASE(
    "the status of a batch requests another try if that may help, else it is the smallest that failed") {
  CHECK(exit_of({}) == Exit::done);
  CHECK(exit_of({job("a", Exit::done, 0)}) == Exit::done);
  CHECK(exit_of({job("a", Exit::limit, {}), job("b", Exit::program_text, {}), job("c", Exit::done, 0)}) ==
        Exit::program_text);
  CHECK(exit_of({job("a", Exit::internal, {}), job("b", Exit::transient_io, {}), job("c", Exit::done, 0)}) ==
        Exit::transient_io);
}

TEST_CASE("the table shows the worst jobs, the number of others, and reasons of failures") {
  std::vector<JobOutcome> jobs{job("bad.ngc", Exit::not_compensated, {}, {})};
  for (int i = 0; i < 5; ++i) jobs.push_back(job("part" + std::to_string(i), Exit::done, 0.001 * i));
  const std::string text = summary_table(jobs, 3);
  CHECK(text.find("not within tolerance") < text.find("bad.ngc"));
  CHECK(text.find("part4") < text.find("part3"));
  CHECK(text.find("part2") == std::string::npos);
  CHECK(text.find("and 3 more") != std::string::npos);
  CHECK(text.find("5 of 6 jobs done, 1 failed") != std::string::npos);
  CHECK(text.find("  bad.ngc:1:1: error: \"no\", it said\n") != std::string::npos);
}

TEST_CASE("the documents agree, and can be read back with any characters in names") {
  const std::vector<JobOutcome> jobs{job("a, \"b\".ngc", Exit::done, 0.0041),
                                     job("\xff.ngc", Exit::limit, {}, {})};
  const auto document = nlohmann::json::parse(summary_json(jobs, "1.2"));
  CHECK(document["tool"] == "counterflex 1.2");
  CHECK(document["counts"]["failed"] == 1);
  CHECK(document["exit_status"] == 6);
  CHECK(document["jobs"][0]["before_mm"].is_null());
  CHECK(document["jobs"][1]["program"] == "a, \"b\".ngc");
  CHECK(document["jobs"][1]["after_mm"] == 0.0041);
  const std::string csv = summary_csv(jobs);
  CHECK(csv.find("\n\"a, \"\"b\"\".ngc\",\"out/a, \"\"b\"\".ngc\",done,0,1.000000,0.004100,,0,0,,OK,\n") !=
        std::string::npos);
  CHECK(csv.find(",limit exceeded,6,,,,0,0,\"\xff.ngc:1:1: error: \"\"no\"\", it said\",FAILED,\n") !=
        std::string::npos);
}

TEST_CASE("a job whose verdict is PARTLY is never called done, whether it is accepted or not") {
  JobOutcome accepted = job("accepted", Exit::done, 0.0095),
             refused = job("refused", Exit::not_compensated, 0.0095);
  accepted.verdict = refused.verdict = "PARTLY";
  accepted.verdict_reason = refused.verdict_reason = "54 % of the cutting length, worst 0.0095 mm > 0.005";
  const std::vector<JobOutcome> jobs{accepted, refused, job("good", Exit::done, 0.001)};
  CHECK(exit_of(jobs) == Exit::not_compensated);
  CHECK(programs(worst_first(jobs)) == std::vector<std::string>{"refused", "accepted", "good"});
  const std::string text = summary_table(jobs, 3);
  CHECK(text.find("1 of 3 jobs done, 1 partly, 1 failed") != std::string::npos);
  CHECK(text.find("  54 % of the cutting length, worst 0.0095 mm > 0.005\n") != std::string::npos);
  const auto document = nlohmann::json::parse(summary_json(jobs, "1.2"));
  CHECK(document["counts"]["done"] == 1);
  CHECK(document["counts"]["partly"] == 1);
  CHECK(document["jobs"][0]["verdict"] == "PARTLY");
  CHECK(document["jobs"][1]["status"] == "partly accepted");
  CHECK(document["jobs"][2]["verdict"] == "OK");
}

TEST_CASE("a job without corrections shows no numbers") {
  JobOutcome nothing = job("macro.nc", Exit::program_text, {}, {});
  nothing.verdict = "NOTHING CORRECTED";
  const std::string text = summary_table({nothing}, 3);
  CHECK(text.find("NOTHING CORRECTED  nothing corrected               -          -          -") !=
        std::string::npos);
}

}  // namespace counterflex
