#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "batch/outcomes.hpp"
#include "counterflex/batch/manifest.hpp"

using counterflex::test::status_of;

namespace counterflex {
namespace {

JobOutcome job(const std::string& program, std::optional<ErrorKind> error, std::optional<double> after,
               std::optional<double> before = 1) {
  JobOutcome outcome;
  outcome.program = program;
  outcome.output = "out/" + program;
  outcome.error_kind = error;
  outcome.before_mm = before;
  outcome.after_mm = after;
  if (!error) outcome.verdict = "OK";
  if (error) outcome.error = program + ":1:1: error: \"no\", it said";
  return outcome;
}

std::vector<std::string> programs(const std::vector<JobOutcome>& outcomes) {
  std::vector<std::string> names;
  for (const JobOutcome& outcome : outcomes) names.push_back(outcome.program);
  return names;
}

}  // namespace

TEST_CASE("failed jobs come first, then those with the largest remaining deviation") {
  const std::vector<JobOutcome> jobs{
      job("small", std::nullopt, 0.001),    job("none", std::nullopt, {}, {}),
      job("large", std::nullopt, 0.004),    job("b", ErrorKind::program_text, {}, {}),
      job("equal", std::nullopt, 0.001, 2), job("a", ErrorKind::limit, {}, {})};
  CHECK(programs(worst_first(jobs)) == std::vector<std::string>{"a", "b", "large", "equal", "small", "none"});
}

TEST_CASE(
    "the status of a batch requests another try if that may help, else it is the smallest that failed") {
  CHECK(error_of({}) == std::nullopt);
  CHECK(error_of({job("a", std::nullopt, 0)}) == std::nullopt);
  CHECK(error_of({job("a", ErrorKind::limit, {}), job("b", ErrorKind::program_text, {}),
                  job("c", std::nullopt, 0)}) == ErrorKind::program_text);
  CHECK(error_of({job("a", ErrorKind::internal, {}), job("b", ErrorKind::transient_io, {}),
                  job("c", std::nullopt, 0)}) == ErrorKind::transient_io);
}

TEST_CASE("the table shows the worst jobs, the number of others, and reasons of failures") {
  std::vector<JobOutcome> jobs{job("bad.ngc", ErrorKind::not_compensated, {}, {})};
  for (int i = 0; i < 5; ++i) jobs.push_back(job("part" + std::to_string(i), std::nullopt, 0.001 * i));
  const std::string text = summary_table(jobs, 3);
  CHECK(text.find("not within tolerance") < text.find("bad.ngc"));
  CHECK(text.find("part4") < text.find("part3"));
  CHECK(text.find("part2") == std::string::npos);
  CHECK(text.find("and 3 more") != std::string::npos);
  CHECK(text.find("5 of 6 jobs done, 1 failed") != std::string::npos);
  CHECK(text.find("  bad.ngc:1:1: error: \"no\", it said\n") != std::string::npos);
}

TEST_CASE("the documents agree, and can be read back with any characters in names") {
  std::vector<JobOutcome> jobs{job("a, \"b\" 50%.ngc", std::nullopt, 0.0041),
                               job("\xff.ngc", ErrorKind::limit, {}, {})};
  jobs[0].warnings = 2;
  jobs[0].moves = 0;
  const auto document = nlohmann::json::parse(summary_json(jobs, "1.2", status_of));
  CHECK(document["tool"] == "counterflex 1.2");
  CHECK(document["counts"]["failed"] == 1);
  CHECK(document["exit_status"] == status_of(ErrorKind::limit));
  CHECK(document["jobs"][0]["exit_status"] == status_of(ErrorKind::limit));
  CHECK(document["jobs"][1]["exit_status"] == 0);
  for (const char* key : {"before_mm", "warnings", "moves"}) CHECK(document["jobs"][0][key].is_null());
  CHECK(document["jobs"][1]["warnings"] == 2);
  CHECK(document["jobs"][1]["moves"] == 0);
  CHECK(document["jobs"][1]["program"] == "a, \"b\" 50%.ngc");
  CHECK(document["jobs"][1]["after_mm"] == 0.0041);
  const std::string csv = summary_csv(jobs, status_of);
  CHECK(csv.find(
            "\n\"a, \"\"b\"\" 50%.ngc\",\"out/a, \"\"b\"\" 50%.ngc\",done,0,1.000000,0.004100,,2,0,,OK,\n") !=
        std::string::npos);
  CHECK(csv.find(",limit exceeded,60,,,,,,\"\xff.ngc:1:1: error: \"\"no\"\", it said\",FAILED,\n") !=
        std::string::npos);
}

TEST_CASE("a job whose verdict is PARTLY is never called done, whether it is accepted or not") {
  JobOutcome accepted = job("accepted", std::nullopt, 0.0095),
             refused = job("refused", ErrorKind::not_compensated, 0.0095);
  accepted.verdict = refused.verdict = "PARTLY";
  accepted.verdict_reason = refused.verdict_reason = "54 % of the cutting length, worst 0.0095 mm > 0.005";
  const std::vector<JobOutcome> jobs{accepted, refused, job("good", std::nullopt, 0.001)};
  CHECK(error_of(jobs) == ErrorKind::not_compensated);
  CHECK(programs(worst_first(jobs)) == std::vector<std::string>{"refused", "accepted", "good"});
  const std::string text = summary_table(jobs, 3);
  CHECK(text.find("1 of 3 jobs done, 1 partly, 1 failed") != std::string::npos);
  CHECK(text.find("  54 % of the cutting length, worst 0.0095 mm > 0.005\n") != std::string::npos);
  const auto document = nlohmann::json::parse(summary_json(jobs, "1.2", status_of));
  CHECK(document["counts"]["done"] == 1);
  CHECK(document["counts"]["partly"] == 1);
  CHECK(document["jobs"][0]["verdict"] == "PARTLY");
  CHECK(document["jobs"][1]["status"] == "partly accepted");
  CHECK(document["jobs"][2]["verdict"] == "OK");
}

TEST_CASE("a job without corrections shows no numbers") {
  JobOutcome nothing = job("macro.nc", ErrorKind::program_text, {}, {});
  nothing.verdict = "NOTHING CORRECTED";
  const std::string text = summary_table({nothing}, 3);
  CHECK(text.find("NOTHING CORRECTED  nothing corrected               -          -          -") !=
        std::string::npos);
}

}  // namespace counterflex
