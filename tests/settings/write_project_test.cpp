#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "counterflex/settings/project_file.hpp"
#include "setting_texts.hpp"

using namespace counterflex;

namespace {

using Texts = std::vector<std::string>;

Setting flag(const std::string& option, const Texts& values) {
  return {option, values, {}, Origin::flag};
}

/// The settings read from a file in the working directory with `settings`.
std::vector<Setting> read_back(const std::vector<Setting>& settings) {
  return read_project(to_project_text(settings), "counterflex.toml");
}

}  // namespace

TEST_CASE("written settings are read as the same settings") {
  const std::vector<Setting> settings{
      flag("machine", {"../shop/mill \"5\" \\ b.toml"}),
      flag("forces", {"a.csv", "/abs/b\n.toml"}),
      flag("force", {"1,2,3", "T3=4,5,6"}),
      flag("load-scale", {"0"}),
      flag("air-above", {"-2.5"}),
      flag("blend-mm", {"0.1"}),
      flag("dialect", {"fanuc"}),
      flag("units", {"inch"}),
      flag("integer-words", {"units"}),
      flag("expand-subprograms", {"true"}),
      flag("tool-table", {"t.tbl"}),
      flag("method", {"nested"}),
      flag("tolerance-mm", {"0.0050000000000000001"}),
      flag("max-correction-mm", {"5"}),
      flag("accept-partial", {"true"}),
      flag("decimals", {"4"}),
      flag("threads", {"3"}),
      flag("min-block-ms", {"0.00001"}),
      flag("output", {"x/{name}_CF{ext}"}),
      flag("report", {"{output}"}),
      flag("plot", {}),
      flag("work", {"G54=1,2.5,-3/touched=0,0.5,-1", "G54.1 P3=0,0,0,0,0,90/machine", "G55=1,2,3"}),
      flag("tool-length", {"T1=50", "T12=62.25"})};
  const auto read = read_back(settings);
  REQUIRE(read.size() == settings.size());
  for (const Setting& setting : settings) {
    CAPTURE(setting.option);
    if (setting.option == "tolerance-mm")
      CHECK(test::values(read, setting.option) == Texts{"0.005"});
    else
      CHECK(test::values(read, setting.option) == setting.values);
  }
}

TEST_CASE("numbers as the command line takes them become numbers as TOML takes them") {
  const auto read =
      read_back({flag("air-above", {".5"}), flag("tolerance-mm", {"+5e-3"}), flag("blend-mm", {"2."}),
                 flag("work", {"g59.1= 1, +2 ,.5"}), flag("tool-length", {"01=+5."})});
  CHECK(test::value(read, "air-above") == "0.5");
  CHECK(test::value(read, "tolerance-mm") == "0.005");
  CHECK(test::value(read, "blend-mm") == "2");
  CHECK(test::value(read, "work") == "G59.1=1,2,0.5");
  CHECK(test::value(read, "tool-length") == "T1=5");
}

TEST_CASE("machine coordinates are written as one line") {
  CHECK(test::value(read_back({flag("work", {"machine"})}), "work") == "machine");
}

TEST_CASE("a number of any size is written as TOML reads it") {
  for (const double size : {5e-324, 2.2250738585072014e-308, 1.2345678901234567e-300, 9.999999999999999e-7,
                            1e-6, 0.1, 123456.789, 999999999999999.9, 1e15, 9007199254740993.0,
                            9223372036854775807.0, 1e19, 1.2345678901234567e200, 1.7976931348623157e308})
    for (const double value : {size, -size}) {
      CAPTURE(value);
      const auto text = fmt::format("{}", value);
      const auto read = read_back({flag("air-above", {text}), flag("work", {"G54=" + text + ",0,0"})});
      CHECK(read_number(test::value(read, "air-above")) == value);
      CHECK(test::value(read, "work") == "G54=" + test::value(read, "air-above") + ",0,0");
    }
}

TEST_CASE(
    "a name whose bytes are not UTF-8 is not written, but refused by its place; in a comment it has marks") {
  const auto problem = [](const Setting& setting) -> std::string {
    try {
      to_project_text({setting});
    } catch (const InputError& error) {
      CHECK(error.kind() ==
            (setting.origin == Origin::file ? ErrorKind::machine_or_force : ErrorKind::usage));
      return error.what();
    }
    return "none";
  };
  const std::string why = " is 'a?.toml', whose bytes are not UTF-8, as a project file must be";
  CHECK(problem(flag("machine", {"a\xFF.toml"})) == "error: --machine" + why);
  CHECK(problem({"machine", {"a\xFF.toml"}, {"COUNTERFLEX_MACHINE"}, Origin::environment}) ==
        "COUNTERFLEX_MACHINE: error: machine" + why);
  CHECK(problem({"forces", {"b", "a\xC3.toml"}, {}, Origin::file, {{"p.toml", 3, 1}, {"p.toml", 4, 2}}}) ==
        "p.toml:4:2: error: forces" + why);
  CHECK(problem(flag("machine", {"f\u00E4rbe.toml"})) == "none");
  CHECK(test::contains(
      to_project_text({{"decimals", {"4"}, {"\xFF\u00E4\xED\xA0\x80.toml", 7, 1}, Origin::file}}),
      "# ?\u00E4???.toml:7\n"));
}

TEST_CASE("of two values for one offset or tool the later one is written: it is the one that counts") {
  const auto read =
      read_back({flag("work", {"g54=1,1,1", "G54=2,2,2"}), flag("tool-length", {"T1=5", "1=6"})});
  CHECK(test::value(read, "work") == "G54=2,2,2");
  CHECK(test::value(read, "tool-length") == "T1=6");
}

TEST_CASE("explicitly empty settings are written as empty") {
  const auto read =
      read_back({flag("report", {}), flag("force", {}), flag("work", {}), flag("tool-length", {})});
  for (const char* option : {"report", "force", "work", "tool-length"})
    CHECK(test::values(read, option).empty());
}

TEST_CASE("each line has the origin of its value, on one line for any name of the file") {
  const std::string text =
      to_project_text({flag("machine", {"m"}),
                       {"method", {"nested"}, {"COUNTERFLEX_METHOD"}, Origin::environment},
                       {"decimals", {"4"}, {"a\nb.toml", 7, 1}, Origin::file},
                       {"blend-mm", {"2"}, {}, Origin::builtin}});
  CHECK(test::contains(text, "machine = \"m\"                             # --machine\n"));
  CHECK(test::contains(text, "# COUNTERFLEX_METHOD\n"));
  CHECK(test::contains(text, "# a?b.toml:7\n"));
  CHECK(test::contains(text, "blend_mm = 2                              # default\n"));
  const auto project =
      test::project_with("[work.G54]\nxyz_mm = [1, 2, 3]\n[work.\"G54.1 P3\"]\nxyz_mm = [1, 2, 3]\n");
  const std::string tables = to_project_text(project);
  CHECK(test::contains(tables, "# p.toml:2\n[work.G54]\nxyz_mm = [1, 2, 3]\n"));
  CHECK(test::contains(tables, "# p.toml:4\n[work.\"G54.1 P3\"]\n"));
}
