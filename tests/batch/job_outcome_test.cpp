#include "batch/outcomes.hpp"
#include "counterflex/batch/manifest.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string any_bytes(std::mt19937& random) {
  std::string bytes(random() % 12, '\0');
  for (char& byte : bytes) byte = "%%25\xC3\xA9\xE2\x82\xAC\xFF\x80\xED\xA0\n\"\\/a\x7F\x01"[random() % 21];
  return bytes;
}

double any_number(std::mt19937& random) {
  return std::ldexp(static_cast<double>(random()) - 2e9, static_cast<int>(random() % 200) - 100);
}

}  // namespace

TEST_CASE("reading a written outcome restores it") {
  for (int number = 0; number < 4; ++number)
    for (const JobOutcome& outcome : {made_up_outcome(number), failed_outcome(number), JobOutcome{}}) {
      const std::string line = to_json_line(outcome, status_of);
      CAPTURE(line);
      CHECK(outcome_of(line, status_of) == outcome);
      CHECK(line.find('\n') == std::string::npos);
    }
}

TEST_CASE("reading restores names and diagnostics of any bytes, and numbers of any size") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    JobOutcome outcome = failed_outcome(trial);
    outcome.program = any_bytes(random);
    outcome.error = any_bytes(random);
    outcome.inputs = {{any_bytes(random), sha256("x")}};
    outcome.before_mm = any_number(random);
    outcome.after_mm = any_number(random);
    const std::string line = to_json_line(outcome, status_of);
    CAPTURE(line);
    REQUIRE(outcome_of(line, status_of) == outcome);
    REQUIRE(line.find('\n') == std::string::npos);
  }
}

TEST_CASE("a name is written unchanged except for the percent sign and bytes that are not UTF-8") {
  JobOutcome outcome;
  outcome.program = "Fr\xC3\xA4ser 50%/\xFF.ngc";
  CHECK(to_json_line(outcome, status_of).find("\"program\":\"Fr\xC3\xA4ser 50%25/%FF.ngc\"") !=
        std::string::npos);
}

TEST_CASE("a line that differs from the written form of an outcome is refused") {
  const std::string line = to_json_line(made_up_outcome(1), status_of);
  for (const std::string& wrong :
       {std::string(), line + " ", line + "}", line.substr(1), "{" + line.substr(1, 20), std::string("{}"),
        std::string("[]"), std::string("null"), std::string("1e999"), "{\"more\":1," + line.substr(1),
        std::string(100000, '[')}) {
    CAPTURE(wrong.substr(0, 200));
    try {
      (void)outcome_of(wrong, status_of);
      FAIL("it is read");
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::internal);
    }
  }
}
