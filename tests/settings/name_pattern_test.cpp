#include <doctest/doctest.h>

#include "counterflex/settings/jobs_file.hpp"

using namespace counterflex;

TEST_CASE("words of letters in braces are placeholders, other braces are parts of names") {
  CHECK(is_pattern("{name}_CF{ext}"));
  CHECK(is_pattern("a/{other}"));
  CHECK(is_pattern("{Name}"));
  for (const char* text : {"", "part.ngc", "{3F2504E0}/part", "{}", "{name", "name}", "{na me}"}) {
    CAPTURE(text);
    CHECK_FALSE(is_pattern(text));
    CHECK(fill(text, {"n", "e", {}}) == text);
  }
}

TEST_CASE("every placeholder of a pattern is replaced") {
  const NameParts parts{"O1001", ".NC", "out/O1001.comp"};
  CHECK(fill("{name}_CF{ext}", parts) == "O1001_CF.NC");
  CHECK(fill("{name}/{name}", parts) == "O1001/O1001");
  CHECK(fill("{output}.svg", parts) == "out/O1001.comp.svg");
  CHECK(fill("{{name}}", parts) == "{O1001}");
}

TEST_CASE("braces in replaced parts are literal") {
  CHECK(fill("{name}{ext}", {"{ext}", ".{name}", {}}) == "{ext}.{name}");
}

TEST_CASE("an unknown placeholder is reported") {
  CHECK(unknown_placeholder("{name}_{nmae}{ext}", {"a", "", {}}) == "nmae");
  CHECK(unknown_placeholder("{output}", {"a", "", {}}) == "output");
  CHECK(unknown_placeholder("{output}{name}{ext}", {"a", "", "b"}).empty());
}

TEST_CASE("a similar placeholder is suggested, ignoring case") {
  CHECK(nearest_placeholder("nmae") == "name");
  CHECK(nearest_placeholder("NAME") == "name");
  CHECK(nearest_placeholder("Ext") == "ext");
  CHECK(nearest_placeholder("ouput") == "output");
  CHECK(nearest_placeholder("x").empty());
}

TEST_CASE("a path written as a pattern restores that path, with any braces") {
  for (const char* path : {"", "a/b", "proj{x}/", "{name}", "{{name}}", "{{{ext}", "{{}", "{{}x}",
                           "{3F2504E0}/{a}{b}", "{", "{a", "}{", "{{}{{}name}}"}) {
    const std::string pattern = as_pattern(path);
    CAPTURE(path);
    CAPTURE(pattern);
    CHECK_FALSE(is_pattern(pattern));
    CHECK(unknown_placeholder(pattern, {}).empty());
    CHECK(fill(pattern, {"n", "e", "o"}) == path);
    CHECK(fill(pattern + "/{name}", {"n", "e", "o"}) == std::string(path) + "/n");
  }
}
