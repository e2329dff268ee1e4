#include <doctest/doctest.h>

#include <cfloat>
#include <string>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/settings/project_file.hpp"
#include "setting_texts.hpp"

using namespace counterflex;

TEST_CASE("a project file needs only its format") {
  CHECK(read_project("format = \"counterflex-project 1\"\n", "p.toml").empty());
}

TEST_CASE("values become the texts that the command line takes") {
  const auto project = test::project_with(
      "tolerance_mm = 0.002\nload_scale = 1\nair_above = -2.5\ndecimals = 4\nmethod = \"nested\"\n"
      "expand_subprograms = true\n");
  CHECK(test::value(project, "tolerance-mm") == "0.002");
  CHECK(test::value(project, "load-scale") == "1");
  CHECK(test::value(project, "air-above") == "-2.5");
  CHECK(test::value(project, "decimals") == "4");
  CHECK(test::value(project, "method") == "nested");
  CHECK(test::value(project, "expand-subprograms") == "true");
  CHECK(project.size() == 6);
}

TEST_CASE("a number's text is read as the same number") {
  for (const double number : {0.1, 1e-5, 1.0 / 3, DBL_MAX, DBL_MIN, DBL_TRUE_MIN, 123456789.125, -0.0}) {
    char text[64];
    std::snprintf(text, sizeof text, "air_above = %.17e\n", number);
    CAPTURE(text);
    const auto read = read_number(test::value(test::project_with(text), "air-above"));
    REQUIRE(read.has_value());
    CHECK(*read == number);
  }
}

TEST_CASE("relative paths are relative to the folder of their file") {
  const auto project = test::project_with(
      "machine = \"machine.toml\"\nforces = [\"a.csv\", \"/tmp/b.csv\"]\ntool_table = \"../tools.tbl\"\n",
      "shop/jobs/counterflex.toml");
  CHECK(test::value(project, "machine") == "shop/jobs/machine.toml");
  CHECK(test::values(project, "forces") == std::vector<std::string>{"shop/jobs/a.csv", "/tmp/b.csv"});
  CHECK(test::value(project, "tool-table") == "shop/jobs/../tools.tbl");
  CHECK(test::value(test::project_with("machine = \"m.toml\"\n", "counterflex.toml"), "machine") == "m.toml");
}

TEST_CASE("one path of forces can be without brackets") {
  CHECK(test::value(test::project_with("forces = \"a.csv\"\n"), "forces") == "a.csv");
}

TEST_CASE("a force is a text, three or six numbers, or an array of these, which may be empty") {
  using Texts = std::vector<std::string>;
  const auto force = [](const std::string& value) {
    return test::values(test::project_with("force = " + value + "\n"), "force");
  };
  CHECK(force("\"T3=1,2,3\"") == Texts{"T3=1,2,3"});
  CHECK(force("[215, -10, 0.25]") == Texts{"215,-10,0.25"});
  CHECK(force("[1, 2, 3, 4, 5, 6]") == Texts{"1,2,3,4,5,6"});
  CHECK(force("[[1, 2, 3], \"T3=4,5,6\"]") == Texts{"1,2,3", "T3=4,5,6"});
  CHECK(force("[]") == Texts{});
}

TEST_CASE("work offsets and tool lengths are tables, as in a machine file") {
  const auto project = test::project_with(
      "[work.g54]\nxyz_mm = [1, 2.5, -3]\n[work.\"G54.1 P03\"]\nxyz_mm = [0, 0, 0]\nrpy_deg = [0, 0, 90]\n"
      "[tools.T01]\nlength_mm = 50\n[tools.12]\nlength_mm = 62.25\n");
  CHECK(test::values(project, "work") == std::vector<std::string>{"G54.1 P3=0,0,0,0,0,90", "G54=1,2.5,-3"});
  CHECK(test::values(project, "tool-length") == std::vector<std::string>{"T12=62.25", "T1=50"});
}

TEST_CASE("a work offset can state its datum, and work = \"machine\" means no offset") {
  const auto project = test::project_with(
      "[work.G54]\nxyz_mm = [1, 2, 3]\ndatum = { touched_at_mm = [10, -0.5, 0] }\n"
      "[work.G55]\nxyz_mm = [1, 2, 3]\nrpy_deg = [0, 0, 90]\ndatum = \"machine\"\n"
      "[work.G56]\nxyz_mm = [0, 0, 0]\ndatum = \"true\"\n");
  CHECK(test::values(project, "work") == std::vector<std::string>{"G54=1,2,3/touched=10,-0.5,0",
                                                                  "G55=1,2,3,0,0,90/machine",
                                                                  "G56=0,0,0/machine"});
  CHECK(test::value(test::project_with("work = \"machine\"\n"), "work") == "machine");
}

TEST_CASE(
    "a pattern without a folder is for the program's folder, one with a folder is relative to the file") {
  const auto output = [](const std::string& text) {
    return test::value(test::project_with("output = \"" + text + "\"\n", "shop/counterflex.toml"), "output");
  };
  CHECK(output("{name}_CF{ext}") == "{name}_CF{ext}");
  CHECK(output("corrected/{name}_CF{ext}") == "shop/corrected/{name}_CF{ext}");
  CHECK(output("corrected/") == "shop/corrected/");
  CHECK(output("/out/{name}{ext}") == "/out/{name}{ext}");
  CHECK(output("-") == "-");
}

TEST_CASE("true puts reports and plots beside the output, false overrides another file") {
  const auto both = test::project_with("report = true\nplot = true\n");
  CHECK(test::value(both, "report") == "{output}");
  CHECK(test::value(both, "plot") == "{output}.svg");
  const auto none = test::project_with("report = false\nplot = false\n");
  CHECK(none.size() == 2);
  CHECK(test::values(none, "report").empty());
  CHECK(test::value(test::project_with("report = \"r/{name}\"\n", "d/p.toml"), "report") == "d/r/{name}");
}

TEST_CASE("settings and their values have places, in bytes") {
  const auto project = test::project_with("# \xC3\xA4\nforces = [\"\xC3\xA4.csv\", \"b.csv\"]\n", "p.toml");
  const Setting& forces = test::setting(project, "forces");
  CHECK(forces.origin == Origin::file);
  CHECK(forces.where.file == "p.toml");
  CHECK(forces.where.line == 3);
  CHECK(forces.where.column == 10);
  CHECK(place_of(forces, 1).column == 21);
}

TEST_CASE("messages name an option in the form of its source") {
  CHECK(shown_option("tolerance-mm", Origin::flag) == "--tolerance-mm");
  CHECK(shown_option("tolerance-mm", Origin::environment) == "COUNTERFLEX_TOLERANCE_MM");
  CHECK(shown_option("tolerance-mm", Origin::file) == "tolerance_mm");
  CHECK(shown_option("tool-length", Origin::file) == "tools");
}
