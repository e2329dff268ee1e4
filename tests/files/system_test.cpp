#include "counterflex/files/system.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"

// These laws hold on every system: tests/windows/run runs this file on Windows, too.
using namespace counterflex;

namespace {

/// An empty folder whose name has letters of two and three bytes, which is removed with the test.
struct NamedFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("counterflex Fräse φ ⌀ " + std::to_string(::getpid()));
  NamedFolder() { make_folder(path.string()); }
  ~NamedFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::string file(const std::string& name) const { return (path / name).string(); }
  std::size_t count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator()));
  }
};

std::string text_at(int descriptor, std::size_t offset) {
  std::array<char, 64> bytes{};
  const std::ptrdiff_t n = system::read_at(descriptor, bytes.data(), bytes.size(), offset);
  return n < 0 ? "failed" : std::string(bytes.data(), static_cast<std::size_t>(n));
}

}  // namespace

TEST_CASE("a file whose name is UTF-8 keeps this name and all of its bytes") {
  const NamedFolder folder;
  for (const char* name : {"plain.nc", "ö.nc", "ρ ⌀.nc", "𝛿.nc"}) {
    CAPTURE(name);
    const std::string file = folder.file(name);
    write_file(file, "a\r\nb\n\x1A\0c");
    write_file(file, std::string_view("a\r\nb\n\x1A\0c", 8));
    CHECK(read_file(file) == std::string_view("a\r\nb\n\x1A\0c", 8));
    CHECK(std::filesystem::path(file).filename().string() == name);
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
      found += entry.path().filename().string() == name;
    CHECK(found == 1);
  }
  CHECK(folder.count() == 4);
}

TEST_CASE("the facts of a path and of its descriptor are the same, and change with the bytes") {
  const NamedFolder folder;
  const std::string file = folder.file("x");
  write_file(file, "123");
  const int descriptor = system::open_to_read(file);
  REQUIRE(descriptor >= 0);
  const auto by_path = system::facts_of(file), by_descriptor = system::facts_of(descriptor);
  ::close(descriptor);
  REQUIRE(by_path);
  REQUIRE(by_descriptor);
  CHECK(by_path->kind == system::FileKind::file);
  CHECK(by_path->size == 3);
  CHECK(by_path->inode == by_descriptor->inode);
  CHECK(by_path->device == by_descriptor->device);
  CHECK(by_path->written_ns == by_descriptor->written_ns);
  write_file(file, "1234");
  CHECK(system::facts_of(file)->size == 4);
  CHECK(system::facts_of(folder.path.string())->kind == system::FileKind::folder);
  CHECK_FALSE(system::facts_of(folder.file("missing")));
  CHECK(errno == ENOENT);
}

TEST_CASE("what is appended is read anywhere, whatever was read before") {
  const int file = system::make_nameless_file();
  REQUIRE(file >= 0);
  CHECK(system::append(file, "hello "));
  CHECK(text_at(file, 1) == "ello ");
  CHECK(system::append(file, "world"));
  CHECK(text_at(file, 0) == "hello world");
  CHECK(text_at(file, 11).empty());
  ::close(file);
}

TEST_CASE("an exclusive lock keeps others out until it is closed, and its text can be read") {
  const NamedFolder folder;
  const int holder = system::open_or_make(folder.file("lock")),
            other = system::open_or_make(folder.file("lock"));
  REQUIRE(holder >= 0);
  REQUIRE(other >= 0);
  CHECK(system::lock(holder, true));
  CHECK(system::replace_text(holder, "holder of the lock"));
  CHECK_FALSE(system::lock(other, false));
  CHECK(errno == EWOULDBLOCK);
  CHECK(text_at(other, 0) == "holder of the lock");
  CHECK(system::replace_text(holder, "me"));
  CHECK(text_at(other, 0) == "me");
  ::close(holder);
  CHECK(system::lock(other, false));
  const int third = system::open_or_make(folder.file("lock"));
  CHECK(system::lock(third, false));
  ::close(other);
  ::close(third);
}

TEST_CASE("a file that is being written is not swept, and its name disappears with an interrupted process") {
  const NamedFolder folder;
  {
    FileWriter writer(folder.file("out"));
    writer.write("x");
    CHECK(sweep_abandoned({folder.file("out")}) == 0);
    writer.complete();
    CHECK(sweep_abandoned({folder.file("out")}) == 0);
    CHECK(folder.count() == 1);
    remove_unpublished();
  }
  CHECK(folder.count() == 0);
  write_file(temporary_name(folder.file("out"), 1, 0), "left by a process that was killed");
  CHECK(sweep_abandoned({folder.file("out")}) == 1);
  CHECK(folder.count() == 0);
}

TEST_CASE("a file that another program has opened is replaced whole, or stays whole") {
  const NamedFolder folder;
  const std::string file = folder.file("out");
  write_file(file, "old");
  const std::ifstream opened(std::filesystem::path{file});
  REQUIRE(opened.good());
  std::string expected = "new";
  try {
    write_file(file, "new");
  } catch (const InputError& refused) {  // Windows
    CHECK(refused.kind() == ErrorKind::transient_io);
    CHECK(std::string(refused.what()).find("another program has opened it") != std::string::npos);
    expected = "old";
  }
  CHECK(read_file(file) == expected);
  CHECK(folder.count() == 1);
}

TEST_CASE(
    "two processes that write one file at once, and remove what killed ones left, do not disturb each "
    "other") {
  const NamedFolder folder;
  const std::string file = folder.file("out");
  std::atomic<bool> goes_on{true};
  std::atomic<int> failures{0};
  std::thread other([&] {
    while (goes_on) sweep_abandoned({file});
  });
  for (int i = 0; i < 300; ++i) {
    try {
      FileWriter writer(file);
      writer.write("whole");
      writer.publish();
    } catch (const InputError&) {
      ++failures;
    }
  }
  goes_on = false;
  other.join();
  CHECK(failures == 0);
  CHECK(read_file(file) == "whole");
  CHECK(folder.count() == 1);
}

TEST_CASE("the errors of missing files, of folders and of names in use are those of POSIX") {
  const NamedFolder folder;
  CHECK(system::open_to_read(folder.file("missing")) < 0);
  CHECK(errno == ENOENT);
  CHECK(system::make_file(folder.file("missing/file")) < 0);
  CHECK(errno == ENOENT);
  write_file(folder.file("file"), "x");
  CHECK(system::make_file(folder.file("file")) < 0);
  CHECK(errno == EEXIST);
  CHECK_FALSE(system::make_folder(folder.file("file")));
  CHECK(errno == EEXIST);
}
