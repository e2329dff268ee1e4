#include <doctest/doctest.h>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/report/report.hpp"
#include "files/folder.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string write(const Folder& folder, const std::string& name, const std::string& text) {
  write_file(folder.file(name), text);
  return folder.file(name);
}

constexpr const char* small_report =
    R"({"schema": "counterflex-report 1", "machine": "A < B", "warning_count": 2})";

std::string page_of(const std::string& runs) {
  return "<!doctype html>\n<script>not this</script>\n<script type=\"application/json\" "
         "id=\"counterflex-data\">"
         R"({"schema": "counterflex-page 1", "runs": [)" +
         runs + "]}</script>\n</html>\n";
}

std::string page_run(const std::string& report) {
  return R"({"report": )" + report +
         R"(, "curves": {"waypoints": 3}, "loads": null, "machine": {"axes": []}})";
}

/// Data as in pages.
std::string without_tags(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<'))
    text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

TEST_CASE("a report comes with the curves of the page beside it, if that shows the same report") {
  const Folder folder;
  const std::string json = write(folder, "run.json", small_report);
  CHECK(contains(read_report_file(json, WithCurves::yes).remark, "is missing"));
  CHECK(read_report_file(json, WithCurves::no).remark.empty());

  write(folder, "run.html", page_of(page_run(without_tags(small_report))));
  const ReportFile file = read_report_file(json, WithCurves::yes);
  CHECK(file.remark.empty());
  CHECK(file.curves == R"({"waypoints":3})");
  CHECK(file.machine == R"({"axes":[]})");
  CHECK(file.loads.empty());
  CHECK(file.report == small_report);
  CHECK(file.sha256 == sha256(small_report));
  CHECK(file.name == "run");
  CHECK(read_report_file(json, WithCurves::no).curves.empty());
}

TEST_CASE("order of keys and blanks do not matter for the equality of reports") {
  const Folder folder;
  const std::string json =
      write(folder, "run.json",
            R"({ "warning_count": 2.0, "machine": "A < B", "schema": "counterflex-report 1" })");
  write(folder, "run.html", page_of(page_run(without_tags(small_report))));
  CHECK_FALSE(read_report_file(json, WithCurves::yes).curves.empty());
}

TEST_CASE("a byte order mark before a report does not reach the page") {
  const Folder folder;
  const std::string text = "\xEF\xBB\xBF" + std::string(small_report);
  const std::string json = write(folder, "run.json", text);
  write(folder, "run.html", page_of(page_run(without_tags(small_report))));
  const ReportFile file = read_report_file(json, WithCurves::yes);
  CHECK(file.report == small_report);
  CHECK(file.remark.empty());
  CHECK(file.sha256 == sha256(text));
  CHECK_THROWS_WITH_AS(read_report_file(write(folder, "bad.json", "\xEF\xBB\xBF{\n nix}"), WithCurves::no),
                       doctest::Contains("bad.json:2:3: error: is not JSON"), InputError);
}

TEST_CASE("with a foreign or broken page only the curves are missing") {
  const Folder folder;
  const std::string json = write(folder, "run.json", small_report);
  write(folder, "run.html", page_of(page_run(R"({"schema": "counterflex-report 1"})")));
  CHECK(contains(read_report_file(json, WithCurves::yes).remark, "shows another report"));
  for (const std::string& broken :
       {std::string("<html></html>"), page_of(""), page_of("{}, {}"), page_of("{"), std::string(),
        page_of(R"({"report": {"machine": 1e999}})")}) {
    CAPTURE(broken);
    write(folder, "run.html", broken);
    const ReportFile file = read_report_file(json, WithCurves::yes);
    CHECK(contains(file.remark, "the comparison has no curves of it"));
    CHECK(file.curves.empty());
  }
}

TEST_CASE("a page without its JSON file gives the same report") {
  const Folder folder;
  const std::string page = write(folder, "run.html", page_of(page_run(without_tags(small_report))));
  const ReportFile file = read_report_file(page, WithCurves::yes);
  CHECK(file.curves == R"({"waypoints":3})");
  CHECK(contains(file.report, R"("machine": "A < B")"));
  CHECK(file.name == "run");
  CHECK_THROWS_WITH_AS(read_report_file(write(folder, "two.html", page_of("{}, {}")), WithCurves::yes),
                       doctest::Contains("the page shows 2 runs"), InputError);
}

TEST_CASE("an input that is not a report is refused at its place") {
  const Folder folder;
  const auto refusal = [&](const std::string& name, const std::string& text) -> std::string {
    try {
      read_report_file(write(folder, name, text), WithCurves::no);
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::usage);
      return std::string(error.what()).substr(folder.path.string().size() + 1);
    }
    return "";
  };
  CHECK(contains(refusal("a.json", "{\n  \"schema\": nix\n}"),
                 "a.json:2:14: error: is not JSON: syntax error"));
  CHECK(refusal("a.json", "{\n  \"schema\": \"counterflex-analysis 1\"\n}") ==
        "a.json:2:3: error: the document's schema is \"counterflex-analysis 1\"; only \"counterflex-report "
        "1\" can "
        "be compared");
  CHECK(contains(refusal("a.json", "[1, 2]"), "a.json:1:1: error: the document's schema is missing"));
  CHECK(contains(refusal("a.json", ""), "a.json:1:1: error: is not JSON"));
  const std::string deep = "{\"machine\": " + std::string(100000, '[') + std::string(100000, ']') + "}";
  CHECK(refusal("a.json", deep) == "a.json:1:112: error: lists and objects are nested more than 100 deep");
  CHECK(contains(
      refusal("a.json", "{\"schema\": \"" + std::string(200, '[') + "\\\"" + std::string(200, '{') + "\"}"),
      "the document's schema is"));
  CHECK(refusal("a.json", "{\"machine\": \"\\\"1e999\",\n  \"k\": [1, 1e999]}") ==
        "a.json:2:12: error: cannot be read: number overflow parsing '1e999'");
  CHECK(
      contains(refusal("a.html", page_of("{\"report\": -1e999}")), "a.html:3:108: error: cannot be read: "));
  CHECK(contains(refusal("a.html", "<html>"), "a.html:1:1: error: is not a page of counterflex"));
  CHECK(contains(refusal("a.html", page_of("{,")), "a.html:3:98: error: is not JSON"));
  CHECK(contains(refusal("a.html", page_of("{\"report\": null}")), "the document's schema is missing"));
  CHECK_THROWS_AS(read_report_file(folder.file("missing.json"), WithCurves::no), InputError);
}

TEST_CASE("runs of one name are distinguished by their folders, up to the first difference") {
  const auto named = [](const std::string& path) { return ReportFile{.name = "run", .path = path}; };
  const auto names = [&](const std::string& path_a, const std::string& path_b) {
    ReportFile a = named(path_a), b = named(path_b);
    tell_apart(a, b);
    return a.name + ", " + b.name;
  };
  CHECK(names("old/run.json", "new/run.json") == "old/run, new/run");
  CHECK(names("run.json", "new/run.json") == "run, new/run");
  CHECK(names("/x/a/p/run.json", "/x/b/p/run.json") == "a/p/run, b/p/run");
  CHECK(names("run.json", "run.html") == "run (1), run (2)");
  ReportFile a{.name = "run"}, b{.name = "other"};
  tell_apart(a, b);
  CHECK(a.name == "run");
}
