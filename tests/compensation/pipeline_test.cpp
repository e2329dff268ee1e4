#include "pipeline.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

using namespace counterflex;

namespace {

/// Items are numbers from 0 to `count`; a slot holds one.
struct Line {
  std::size_t count, slots;
  int threads;
  std::vector<std::size_t> held{}, squares{}, ordered{}, ended{};
  std::size_t next = 0, stop_at = static_cast<std::size_t>(-1), throw_at = stop_at;
  std::atomic<int> in_ordered{0};
  std::atomic<bool> two_in_order{false};

  void run() {
    held.resize(slots);
    squares.resize(slots);
    const auto begin = [this](std::size_t slot) {
      if (next == count) return false;
      held[slot] = next++;
      return true;
    };
    const auto square = [this](std::size_t slot, int) {
      if (held[slot] % 3 == 0) std::this_thread::yield();
      squares[slot] = held[slot] * held[slot];
    };
    const auto in_order = [this](std::size_t slot, int) {
      if (++in_ordered > 1) two_in_order = true;
      ordered.push_back(held[slot]);
      if (held[slot] == throw_at) throw std::runtime_error("broken");
      --in_ordered;
    };
    const auto end = [this](std::size_t slot) {
      ended.push_back(squares[slot]);
      return held[slot] != stop_at;
    };
    run_pipeline(begin, {{false, square}, {true, in_order}, {false, square}}, end, slots, threads);
  }
};

}  // namespace

TEST_CASE("all items end, in their order, and pass an ordered stage one by one") {
  for (const int threads : {1, 2, 5})
    for (const std::size_t slots : {1, 3, 8}) {
      Line line{200, slots, threads};
      line.run();
      REQUIRE(line.ended.size() == 200);
      for (std::size_t i = 0; i < 200; ++i) {
        CHECK(line.ended[i] == i * i);
        CHECK(line.ordered[i] == i);
      }
      CHECK_FALSE(line.two_in_order);
    }
}

TEST_CASE("no items are no trouble") {
  Line line{0, 4, 3};
  line.run();
  CHECK(line.ended.empty());
}

TEST_CASE("nothing ends behind the item that stops a pipeline") {
  for (const int threads : {1, 4}) {
    Line line{200, 6, threads};
    line.stop_at = 50;
    line.run();
    CHECK(line.ended.size() == 51);
    CHECK(line.next <= 57);
  }
}

TEST_CASE("what a stage throws ends a pipeline and comes out of it") {
  for (const int threads : {1, 4}) {
    Line line{200, 6, threads};
    line.throw_at = 20;
    CHECK_THROWS_AS(line.run(), std::runtime_error);
    CHECK(line.ended.size() <= 20);
  }
}

TEST_CASE("with one thread everything runs in the calling one, with the threads that there are") {
  const auto here = std::this_thread::get_id();
  int left = 3, most = 0;
  bool elsewhere = false;
  const auto begin = [&](std::size_t) { return left-- > 0; };
  const auto work = [&](std::size_t, int threads) {
    elsewhere = elsewhere || std::this_thread::get_id() != here;
    most = std::max(most, threads);
  };
  run_pipeline(
      begin, {{false, work}}, [](std::size_t) { return true; }, 2, 1);
  CHECK_FALSE(elsewhere);
  CHECK(most == 1);
}
