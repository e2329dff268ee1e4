#include "unsaid.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>

using namespace counterflex::cli;

namespace {

struct Pipe {
  std::array<int, 2> ends{};
  Pipe() { REQUIRE(::pipe2(ends.data(), O_CLOEXEC) == 0); }
  ~Pipe() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  std::string read(std::size_t most) const {
    std::string bytes(most, ' ');
    const ssize_t n = ::read(ends[0], bytes.data(), most);
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }
};

/// Everything that is on its way through the pipe.
std::string all_of(Unsaid& unsaid, const Pipe& pipe) {
  ::fcntl(pipe.ends[0], F_SETFL, O_NONBLOCK);
  std::string text;
  for (std::string more; !(more = pipe.read(5000)).empty(); unsaid.send(0)) text += more;
  return text;
}

}  // namespace

TEST_CASE("text that a full pipe does not take is kept, in order, and the writer does not wait") {
  const Pipe pipe;
  Unsaid unsaid(pipe.ends[1]);
  std::string said;
  for (int i = 0; i < 20000; ++i) {
    said += std::to_string(i) + "\n";
    unsaid.add(std::to_string(i) + "\n");
  }
  CHECK_FALSE(unsaid.is_clear());
  CHECK_FALSE(unsaid.send(1));
  CHECK(all_of(unsaid, pipe) == said);
  CHECK(unsaid.is_clear());
}

TEST_CASE("what nobody takes is dropped from a megabyte on, and no text is cut") {
  const Pipe pipe;
  Unsaid unsaid(pipe.ends[1]);
  const std::string line(999, 'x');
  for (int i = 0; i < 3000; ++i) unsaid.add(line + "\n");
  const std::string text = all_of(unsaid, pipe);
  CHECK(text.size() % 1000 == 0);
  CHECK(text.size() > 1000 * 1000);
  CHECK(text.size() < 1300 * 1000);
}

TEST_CASE("the stream's own flags stay, as others have them too") {
  const Pipe pipe;
  const Unsaid unsaid(pipe.ends[1]);
  CHECK((::fcntl(pipe.ends[1], F_GETFL) & O_NONBLOCK) == 0);
}

TEST_CASE("a file gets what is added behind what it has") {
  std::string name = "/tmp/unsaid-XXXXXX";
  const int file = ::mkstemp(name.data());
  ::unlink(name.c_str());
  REQUIRE(::write(file, "before\n", 7) == 7);
  Unsaid(file).add("after\n");
  std::string bytes(20, ' ');
  bytes.resize(static_cast<std::size_t>(::pread(file, bytes.data(), bytes.size(), 0)));
  CHECK(bytes == "before\nafter\n");
  ::close(file);
}
