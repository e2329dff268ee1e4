#include "counterflex/forces/force_rows.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "counterflex/forces/forces.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using test::wrench;

namespace {

// Forces alone in lines that follow each other, then rows that end the cover and lines left out, then
// moments, of which one is a zero with a sign.
ForceRow numbered(int i) {
  ForceRow row{.key = 2.0 * i, .F = wrench(i, -i, 0.5 * i), .where = {i + 4, 3}};
  if (i > 20'000) row.ends = i % 7 == 3;
  if (i > 22'000) row.where.line += 5;
  if (i == 27'000) row.F[4] = -0.0;
  if (i > 36'000) row.F[5] = 1.0 / i;
  return row;
}

ForceRows many_rows(int count) {
  ForceRows rows;
  for (int i = 0; i < count; ++i) rows.push_back(numbered(i));
  return rows;
}

}  // namespace

TEST_CASE("stored rows are restored, for any number of rows and any order of access") {
  constexpr int count = 50'000;
  const ForceRows rows = many_rows(count);
  REQUIRE(rows.size() == count);
  std::mt19937 random(3);
  for (int k = 0; k < 3000; ++k) {
    const int i = k == 0 ? 27'000 : k < 1500 ? 33 * k : static_cast<int>(random() % count);
    CAPTURE(i);
    const ForceRow row = rows[static_cast<std::size_t>(i)], expected = numbered(i);
    CHECK(row.key == expected.key);
    CHECK(row.F == expected.F);
    CHECK(std::signbit(row.F[4]) == std::signbit(expected.F[4]));
    CHECK(row.where.line == expected.where.line);
    CHECK(row.where.column == expected.where.column);
    CHECK(row.ends == expected.ends);
  }
}

TEST_CASE("the first row beyond a key is found from any previous position") {
  const ForceRows rows = many_rows(30'000);
  std::mt19937 random(5);
  for (int k = 0; k < 3000; ++k) {
    const double key = k < 1500 ? 0.7 * k - 3 : static_cast<double>(random() % 60'100);
    const double expected = key < 0 ? 0 : std::min(30'000.0, std::floor(key / 2) + 1);
    CHECK(rows.beyond(key) == static_cast<std::size_t>(expected));
  }
}

TEST_CASE("a copy of rows is independent") {
  const ForceRows rows = many_rows(20'000);
  ForceRows copy = rows;
  copy.push_back(numbered(20'000));
  CHECK(rows.size() == 20'000);
  CHECK(copy.size() == 20'001);
  CHECK(copy[9].key == rows[9].key);
  CHECK(copy.back().key == 40'000);
}

TEST_CASE("rows report whether one has a wrench, and the box of their points") {
  ForceRows rows;
  CHECK(rows.all_zero());
  rows.push_back({.key = 1});
  rows.push_back({.key = 2, .point = {1, 2, 3}});
  CHECK(rows.all_zero());
  CHECK(rows.point(0) == Vector3(0, 0, 0));
  CHECK(rows.point(1) == Vector3(1, 2, 3));
  rows.push_back({.key = 3, .F = wrench(0, 0, 1e-9)});
  CHECK_FALSE(rows.all_zero());
}

TEST_CASE("reading a file in portions that end inside rows gives the profile of its text") {
  std::string text = "\xEF\xBB\xBF" + test::on_tool + "line,fx_N,fy_N,fz_N\r\n";
  std::mt19937 random(9);
  std::uniform_real_distribution<double> force(-300, 300);
  for (int i = 1; i <= 12'000; ++i)
    text += fmt::format("{}, {:.2f},{:.3f},{:+}\n", i, force(random), force(random), i % 9);
  FileReader bytes = FileReader::of_bytes(text);
  const auto of_file = read_force_csv(bytes, "f.csv"), of_text = read_force_csv(text, "f.csv");
  const ForceRows &a = std::get<ForceProfile>(of_file.at(0).content).rows,
                  &b = std::get<ForceProfile>(of_text.at(0).content).rows;
  REQUIRE(a.size() == 12'000);
  REQUIRE(b.size() == 12'000);
  for (std::size_t i = 0; i < a.size(); i += 17) {
    CHECK(a.key(i) == b.key(i));
    CHECK(a[i].F == b[i].F);
    CHECK(a[i].where.line == static_cast<int>(i) + 4);
  }
}

TEST_CASE("a row of plain numbers equals the same row with blanks around its numbers") {
  std::mt19937 random(11);
  const auto number = [&] {
    const double value = std::uniform_real_distribution<double>(-500, 500)(random);
    const int style = static_cast<int>(random() % 4);
    if (style == 0) return fmt::format("{}", value);
    if (style == 1) return fmt::format("{:.2f}", value);
    return style == 2 ? fmt::format("{:.0f}", value) : fmt::format("{:e}", value);
  };
  for (const std::string sense : {"on_tool", "on_workpiece"}) {
    std::string plain = "# frame = machine\n# sense = " + sense + "\ns_mm,fx_N,mz_Nm,fy_N,fz_N\n",
                blanks = plain;
    for (int i = 1; i < 400; ++i) {
      const std::string key = fmt::format("{}", 0.37 * i), a = number(), b = number(), c = number(),
                        d = number();
      plain += fmt::format("{},{},{},{},{}\n", key, a, b, c, d);
      blanks += fmt::format(" {},{} ,{}, {},{}\t\n", key, a, b, c, d);
    }
    const auto of_plain = read_force_csv(plain, "f.csv"), of_blanks = read_force_csv(blanks, "f.csv");
    const ForceRows &x = std::get<ForceProfile>(of_plain.at(0).content).rows,
                    &y = std::get<ForceProfile>(of_blanks.at(0).content).rows;
    REQUIRE(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(x.key(i) == y.key(i));
      CHECK(x[i].F == y[i].F);
    }
  }
}
