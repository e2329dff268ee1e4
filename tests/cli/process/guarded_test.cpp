#include "process/guarded.hpp"

#include <doctest/doctest.h>

using namespace counterflex;
using namespace counterflex::cli;

TEST_CASE("lack of memory or threads has status 75, other exceptions have not") {
  std::string said;
  Console console({}, {.error = [&](std::string_view diagnostic) { said = diagnostic; }});
  const auto thrown = [&](const auto& error) {
    return guarded(console, [&]() -> std::optional<ErrorKind> { throw error; });
  };
  CHECK(thrown(std::bad_alloc()) == ErrorKind::transient_io);
  CHECK(said == "error: there is not enough memory");
  CHECK(thrown(std::system_error(EAGAIN, std::generic_category())) == ErrorKind::transient_io);
  CHECK(said == "error: the system has no more threads");
  CHECK(thrown(std::system_error(EPERM, std::generic_category())) == ErrorKind::internal);
  CHECK(thrown(std::logic_error("no")) == ErrorKind::internal);
  CHECK(said == "error: internal error: no");
}

TEST_CASE("a diagnostic without a file gets its file") {
  CHECK(with_file("error: no memory", "a.ngc") == "a.ngc: error: no memory");
  CHECK(with_file("b.toml:3:1: error: no", "a.ngc") == "b.toml:3:1: error: no");
}
