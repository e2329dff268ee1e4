#include "counterflex/program/boxed_optional.hpp"

#include <doctest/doctest.h>

#include <string>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a copy of a BoxedOptional has its own value, and a moved one is empty") {
  BoxedOptional<std::string> word = std::string("one");
  BoxedOptional<std::string> copy = word;
  copy->append(" more");
  CHECK(*word == "one");
  CHECK(*copy == "one more");
  const BoxedOptional<std::string> taken = std::move(word);
  CHECK(taken == std::string("one"));
  copy = taken;
  CHECK(*copy == "one");
  CHECK(&*copy != &*taken);
  copy.reset();
  CHECK_FALSE(copy.has_value());
  CHECK(copy.value_or("none") == "none");
}

TEST_CASE("copies of a program's moves have their own arcs, cycles and forces") {
  Program program = read("(FORCE FX=10)\nG21 G17 G0 X0 Y0 Z5 F100\nG2 X10 Y0 I5 J0\nG81 X3 Y3 Z-1 R1\n");
  REQUIRE(program.moves.size() == 3);
  const std::vector<Move> copies = program.moves;
  program.moves[1].arc->centre_mm.x() = 7;
  program.moves[2].cycle->bottom_mm = 7;
  (*program.moves[0].force)[0] = 7;
  CHECK(copies[1].arc->centre_mm.x() == 5);
  CHECK(copies[2].cycle->bottom_mm == -1);
  CHECK((*copies[0].force)[0] == 10);
  CHECK_FALSE(copies[0].arc.has_value());
}

TEST_CASE("a PackedAxisWord returns the word that it was made from, and an empty one has no value") {
  const std::size_t far = std::size_t{5} << 40;
  PackedAxisWord word = AxisWord{{far, far + 7}, 3};
  REQUIRE(word.has_value());
  CHECK(word->number.begin == far);
  CHECK(word->number.end == far + 7);
  CHECK((*word).decimals == 3);
  word.reset();
  CHECK_FALSE(word.has_value());
  CHECK_FALSE(PackedAxisWord(std::nullopt).has_value());
}
