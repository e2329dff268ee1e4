#include "counterflex/settings/name_pattern.hpp"

#include <doctest/doctest.h>

using namespace counterflex;

TEST_CASE("words of lower-case letters in braces are placeholders, other braces are parts of names") {
  CHECK(is_pattern("{name}_CF{ext}"));
  CHECK(is_pattern("a/{other}"));
  for (const char* text : {"", "part.ngc", "{3F2504E0}/part", "{}", "{Name}", "{name", "name}", "{na me}"}) {
    CAPTURE(text);
    CHECK_FALSE(is_pattern(text));
    CHECK(fill(text, {"n", "e", {}}) == text);
  }
}

TEST_CASE("a pattern is filled with the parts of a name, as often as it asks for them") {
  const NameParts parts{"O1001", ".NC", "out/O1001.comp"};
  CHECK(fill("{name}_CF{ext}", parts) == "O1001_CF.NC");
  CHECK(fill("{name}/{name}", parts) == "O1001/O1001");
  CHECK(fill("{output}.svg", parts) == "out/O1001.comp.svg");
  CHECK(fill("{{name}}", parts) == "{O1001}");
}

TEST_CASE("what fills a pattern is not looked at again") {
  CHECK(fill("{name}{ext}", {"{ext}", ".{name}", {}}) == "{ext}.{name}");
}

TEST_CASE("a placeholder that nothing fills is named") {
  CHECK(unknown_placeholder("{name}_{nmae}{ext}", {"a", "", {}}) == "nmae");
  CHECK(unknown_placeholder("{output}", {"a", "", {}}) == "output");
  CHECK(unknown_placeholder("{output}{name}{ext}", {"a", "", "b"}).empty());
}
