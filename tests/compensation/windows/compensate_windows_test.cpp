// Several windows at once: what comes of them does not depend on how many.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <thread>

#include "compensation/support/window_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Cuts of 1 mm to and fro under a force, `wrong` in place of the one numbered `at`.
Order cuts(int count, int at = 0, const std::string& wrong = "") {
  std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int k = 1; k <= count; ++k)
    text += k == at ? wrong + "\n" : fmt::format("X{} Y{}\n", k % 40, 0.5 * (k % 3));
  return {.machine = load_machine(small_mill), .text = text, .force = constant_force({40, -25, 15, 0, 0, 0})};
}

void check_same_bytes(const WindowRun& a, const WindowRun& b) {
  CHECK(a.text == b.text);
  CHECK(a.windows == b.windows);
  CHECK(a.begun == b.begun);
  REQUIRE(a.waypoints.size() == b.waypoints.size());
  for (std::size_t i = 0; i < a.waypoints.size(); ++i) {
    CHECK(a.waypoints[i].line == b.waypoints[i].line);
    CHECK(a.waypoints[i].after == b.waypoints[i].after);
    CHECK(a.waypoints[i].before == b.waypoints[i].before);
  }
}

/// Line and words of the failure; `run` gets the output received before it.
std::string failure_of(const Order& order, WindowRun& run) {
  try {
    run_in_windows(order, 8, {}, run);
  } catch (const InputError& error) {
    return error.what();
  }
  return run.failure ? fmt::format("{}: {}", run.failure->line, run.failure->what) : "none";
}

}  // namespace

TEST_CASE("windows give the same bytes and numbers on any number of threads") {
  Order order = cuts(300);
  order.in_batches = false;
  const WindowRun one = in_windows(order, 8);
  CHECK_FALSE(one.failure);
  CHECK(one.windows > 20);
  for (const int threads : {2, 3, 9}) {
    CAPTURE(threads);
    order.threads = threads;
    check_same_bytes(in_windows(order, 8), one);
  }
}

TEST_CASE("windows whose waypoints are solved side by side give the same bytes on any number of threads") {
  for (const char* machine : {small_mill.c_str(), orthoglide_b.c_str()}) {
    CAPTURE(machine);
    Order order = cuts(600);
    order.machine = load_machine(machine);
    const WindowRun one = in_windows(order, 280);
    CHECK_FALSE(one.failure);
    CHECK(one.windows >= 2);
    order.threads = 3;
    check_same_bytes(in_windows(order, 280), one);
  }
}

TEST_CASE("the first window that fails is named on any number of threads, and none behind it is reported") {
  for (const char* wrong : {"X99999", "X1 F", "X1 X2"}) {
    CAPTURE(wrong);
    Order order = cuts(300, 150, wrong);
    WindowRun one;
    const std::string expected = failure_of(order, one);
    CHECK(expected.find("153") != std::string::npos);
    CHECK(one.windows > 10);
    CHECK(one.windows < 30);
    for (const int threads : {2, 4}) {
      CAPTURE(threads);
      order.threads = threads;
      WindowRun run;
      CHECK(failure_of(order, run) == expected);
      check_same_bytes(run, one);
    }
  }
}

TEST_CASE("a failed window has priority over errors that the reader finds behind it") {
  Order order = cuts(300, 150, "X99999");
  order.text += "X1 F\n";
  for (const int threads : {1, 2, 4}) {
    order.threads = threads;
    WindowRun run;
    CHECK(failure_of(order, run).starts_with("153: "));
  }
}

TEST_CASE("the function that receives a window that was read may refuse it, when its turn comes") {
  Order order = cuts(300);
  for (const int threads : {1, 3}) {
    order.threads = threads;
    WindowRun run;
    const auto refuse = [](const Job& job) {
      if (job.program.moves.back().line > 150)
        throw InputError(ErrorKind::program_text, {"part.ngc", 7}, "no");
    };
    CHECK_THROWS_AS(run_in_windows(order, 8, {}, run, refuse), InputError);
    CHECK(run.windows == run.begun - 1);
    CHECK(run.windows > 10);
    CHECK(run.waypoints.back().line <= 150);
  }
}

TEST_CASE("with one thread everything comes from the calling one, and what an event throws ends the run") {
  const Order order = cuts(300);
  WindowShop shop(order, 8);
  WindowRun run;
  WindowEvents events = events_for(run);
  bool elsewhere = false;
  const auto here = std::this_thread::get_id();
  events.solved = [&](const Job&, const std::vector<Waypoint>&) {
    elsewhere = elsewhere || std::this_thread::get_id() != here;
    if (run.begun == 5) throw std::runtime_error("full");
  };
  CHECK_THROWS_WITH(compensate_windows(*shop.windows, shop.options, TextReader(shop.reader), false, events),
                    "full");
  CHECK_FALSE(elsewhere);
  CHECK(run.windows == 4);
}

TEST_CASE("windows come in their order while others are read, and an error of the reader comes out") {
  for (const int threads : {1, 2, 5})
    for (const bool fails : {false, true}) {
      const Order order = cuts(300, fails ? 250 : 0, "X1 F");
      FileReader bytes = FileReader::of_bytes(order.text);
      ProgramReader reader(bytes, "part.ngc", order.read, 8);
      std::vector<int> first, behind;
      const auto go = [&] {
        for_each_window(
            reader, threads, [&](const Program& window) { first.push_back(window.moves.front().line); },
            [&](const Program& window) { behind.push_back(window.moves.front().line); });
      };
      if (fails)
        CHECK_THROWS_AS(go(), InputError);
      else
        go();
      CHECK(first.size() > 20);
      CHECK(std::is_sorted(first.begin(), first.end()));
      CHECK(first.size() >= behind.size());
      CHECK(first.size() - behind.size() <= (fails ? 2 : 0));
      CHECK(std::equal(behind.begin(), behind.end(), first.begin()));
    }
}
