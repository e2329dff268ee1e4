#include <doctest/doctest.h>

#include "counterflex/forces/forces.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using test::wrench;

namespace {

/// Of a file that is one profile.
ForceProfile profile_in(const std::string& text, const std::string& file) {
  const std::vector<ForceRule> rules = read_force_csv(text, file);
  REQUIRE(rules.size() == 1);
  return std::get<ForceProfile>(rules[0].content);
}

}  // namespace

TEST_CASE("a profile is read with its settings, in SI, columns in any order") {
  const auto profile = profile_in(
      "# measured on the dynamometer, F = mean of three\n"
      "# frame = feed\n#sense=on_tool\n# interpolation = linear\n# at = platform\n"
      "fx_N, fz_N, s_mm, fy_N, mz_Nm\n"
      "215, -25, 0, -10, 1.5\n"
      "# a remark between rows\n"
      "1e2,+3,12.5,-.5,0\n",
      "f.csv");
  CHECK(profile.key == ForceKey::path_length);
  CHECK(profile.frame == ForceFrame::feed);
  CHECK(profile.linear);
  CHECK(profile.at_platform);
  REQUIRE(profile.rows.size() == 2);
  CHECK(profile.rows[0].key == 0);
  CHECK(profile.rows[0].F == wrench(215, -10, -25, 0, 0, 1.5));
  CHECK(profile.rows[1].key == 0.0125);
  CHECK(profile.rows[1].F == wrench(100, -0.5, 3));
  CHECK(profile.rows[1].where.line == 9);
  CHECK(profile.rows[1].where.column == 8);
}

TEST_CASE("without settings for them a profile steps and acts at the tip") {
  const auto profile =
      profile_in("# frame = tool\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,1,2,3\n", "f.csv");
  CHECK_FALSE(profile.linear);
  CHECK_FALSE(profile.at_platform);
}

TEST_CASE("a force on the workpiece is the opposite of that on the tool") {
  const auto profile = profile_in(
      "# frame = machine\n# sense = on_workpiece\nn,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm\n10,1,2,3,4,5,6\n",
      "f.csv");
  CHECK(profile.key == ForceKey::block_number);
  CHECK(profile.rows[0].F == wrench(-1, -2, -3, -4, -5, -6));
}

TEST_CASE("a byte order mark, CRLF, blanks, and empty lines at the end are accepted") {
  const auto profile = profile_in(
      "\xEF\xBB\xBF# frame = work\r\n\r\n# sense = on_tool\r\nt_s ,\tfx_N,fy_N,fz_N \r\n 0,1, 2 "
      ",3\r\n0.5,4,5,6\r\n\r\n \r\n",
      "f.csv");
  CHECK(profile.key == ForceKey::time);
  REQUIRE(profile.rows.size() == 2);
  CHECK(profile.rows[1].key == 0.5);
  CHECK(profile.rows[1].F == wrench(4, 5, 6));
}

TEST_CASE("an empty file has no header, at its first line") {
  CHECK_THROWS_WITH_AS(
      read_force_csv("", "f.csv"),
      "f.csv:1:1: error: no header row, such as 's_mm,fx_N,fy_N,fz_N' after the lines that begin with '#'",
      InputError);
}
