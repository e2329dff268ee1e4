#include "counterflex/settings/environment.hpp"

#include <doctest/doctest.h>

#include "setting_texts.hpp"

using namespace counterflex;

namespace {

template <typename... Variables>
std::vector<Setting> environment_of(Variables... variables) {
  const char* const list[] = {variables..., nullptr};
  return read_environment(list);
}

}  // namespace

TEST_CASE("only variables COUNTERFLEX_OPTION are settings") {
  const auto settings = environment_of("PATH=/bin", "COUNTERFLEX_TOLERANCE_MM=0.01", "COUNTERFLEX_FOO=1",
                                       "COUNTERFLEX_MACHINES=no", "counterflex_machine=no");
  REQUIRE(settings.size() == 1);
  CHECK(test::value(settings, "tolerance-mm") == "0.01");
  CHECK(settings[0].origin == Origin::environment);
  CHECK(settings[0].where.file == "COUNTERFLEX_TOLERANCE_MM");
  CHECK(settings[0].where.line == 0);
}

TEST_CASE("paths and names of outputs are those of files in the folder, as in a project file there") {
  using Texts = std::vector<std::string>;
  const auto in_folder = [](const char* variable, const std::string& option) {
    const char* const list[] = {variable, nullptr};
    return test::values(read_environment(list, "/a{b}"), option);
  };
  CHECK(in_folder("COUNTERFLEX_MACHINE=m.toml", "machine") == Texts{"/a{b}/m.toml"});
  CHECK(in_folder("COUNTERFLEX_MACHINE=-", "machine") == Texts{"-"});
  CHECK(in_folder("COUNTERFLEX_FORCES=a.csv:/b.csv", "forces") == Texts{"/a{b}/a.csv", "/b.csv"});
  CHECK(in_folder("COUNTERFLEX_UNCERTAINTY=u.toml", "uncertainty") == Texts{"/a{b}/u.toml"});
  CHECK(in_folder("COUNTERFLEX_REPORT=r/{name}", "report") == Texts{"/a{{}b}/r/{name}"});
  CHECK(in_folder("COUNTERFLEX_REPORT={name}", "report") == Texts{"{name}"});
  CHECK(in_folder("COUNTERFLEX_REPORT=true", "report") == Texts{"{output}"});
  CHECK(in_folder("COUNTERFLEX_REPORT=false", "report") == Texts{});
  CHECK(in_folder("COUNTERFLEX_PLOT=p.svg", "plot") == Texts{"/a{{}b}/p.svg"});
  CHECK(in_folder("COUNTERFLEX_FORCE=1,2,3", "force") == Texts{"1,2,3"});
}

TEST_CASE("a variable with a name similar to a setting gives a remark, others do not") {
  const char* const list[] = {"COUNTERFLEX_TOLERANCE=1",
                              "COUNTERFLEX_MACHIN=m",
                              "COUNTERFLEX_MACHINE=m",
                              "COUNTERFLEX_PROGRAMS=p",
                              "COUNTERFLEX_BROWSER=b",
                              "COUNTERFLEX_MAX_CORRECTION",
                              "COUNTERFLEX_",
                              "TOLERANCE_M=1",
                              nullptr};
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  CHECK(misspelt_variables(list) == Pairs{{"COUNTERFLEX_TOLERANCE", "COUNTERFLEX_TOLERANCE_MM"},
                                          {"COUNTERFLEX_MACHIN", "COUNTERFLEX_MACHINE"},
                                          {"COUNTERFLEX_MAX_CORRECTION", "COUNTERFLEX_MAX_CORRECTION_MM"}});
}

TEST_CASE("an empty variable is ignored") {
  CHECK(environment_of("COUNTERFLEX_MACHINE=", "COUNTERFLEX_FORCES=").empty());
}

TEST_CASE("a list without values is ignored, and does not override a project file") {
  CHECK(environment_of("COUNTERFLEX_FORCE=:", "COUNTERFLEX_FORCES=::", "COUNTERFLEX_WORK=:").empty());
}

TEST_CASE("values of options that take several are separated by colons") {
  using Texts = std::vector<std::string>;
  const auto settings = environment_of("COUNTERFLEX_FORCES=a.csv:b.csv", "COUNTERFLEX_FORCE=1,2,3:T3=4,5,6",
                                       "COUNTERFLEX_WORK=:G54=1,2,3:", "COUNTERFLEX_TOOL_LENGTH=T1=50:T2=60",
                                       "COUNTERFLEX_MACHINE=a:b.toml");
  CHECK(test::values(settings, "forces") == Texts{"a.csv", "b.csv"});
  CHECK(test::values(settings, "force") == Texts{"1,2,3", "T3=4,5,6"});
  CHECK(test::values(settings, "work") == Texts{"G54=1,2,3"});
  CHECK(test::values(settings, "tool-length") == Texts{"T1=50", "T2=60"});
  CHECK(test::values(settings, "machine") == Texts{"a:b.toml"});
}

TEST_CASE("reports and plots of the environment may be true or false, as in a project file") {
  const auto yes = environment_of("COUNTERFLEX_REPORT=true", "COUNTERFLEX_PLOT=true");
  CHECK(test::value(yes, "report") == "{output}");
  CHECK(test::value(yes, "plot") == "{output}.svg");
  CHECK(test::values(environment_of("COUNTERFLEX_REPORT=false"), "report").empty());
  CHECK(test::value(environment_of("COUNTERFLEX_REPORT=r/{name}"), "report") == "r/{name}");
}
