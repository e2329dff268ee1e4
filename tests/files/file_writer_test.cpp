#include "counterflex/files/file_writer.hpp"

#include <thread>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a file that is written has its name only once it is published") {
  const Folder folder;
  const std::string path = folder.file("out.ngc");
  {
    FileWriter file(path);
    file.write("G1 X1\n");
    file.write(std::string(1 << 20, 'x'));
    CHECK(!std::filesystem::exists(path));
    file.publish();
    CHECK(read_file(path) == "G1 X1\n" + std::string(1 << 20, 'x'));
  }
  CHECK(folder.count() == 1);
}

TEST_CASE("a file that is never published leaves no trace, and the old one is unchanged") {
  const Folder folder;
  write_file(folder.file("out.ngc"), "old");
  { FileWriter(folder.file("out.ngc")).write(std::string(1 << 20, 'x')); }
  { FileWriter(folder.file("new.ngc")).write("x"); }
  CHECK(read_file(folder.file("out.ngc")) == "old");
  CHECK(folder.count() == 1);
}

TEST_CASE("a complete file only needs its name") {
  const Folder folder;
  write_file(folder.file("out.ngc"), "old");
  FileWriter file(folder.file("out.ngc"));
  CHECK(!file.is_stream());
  file.write("G1 X1\n");
  file.complete();
  CHECK(read_file(folder.file("out.ngc")) == "old");
  CHECK(folder.count() == 2);
  std::string written;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path))
    if (entry.path().extension() == ".tmp") written = read_file(entry.path().string());
  CHECK(written == "G1 X1\n");
  file.publish();
  CHECK(read_file(folder.file("out.ngc")) == "G1 X1\n");
  CHECK(folder.count() == 1);
}

TEST_CASE("a complete file that is never published leaves no trace") {
  const Folder folder;
  {
    FileWriter file(folder.file("out.ngc"));
    file.write("x");
    file.complete();
    CHECK(folder.count() == 1);
  }
  CHECK(folder.count() == 0);
}

TEST_CASE("a hash computed while writing is that of the written bytes, for portions of any size") {
  const Folder folder;
  FileWriter file(folder.file("out.ngc")), plain(folder.file("plain.ngc"));
  file.hash_along();
  std::string bytes;
  for (const std::size_t size : {0, 5, 1 << 18, 1 << 20, 7}) {
    const std::string some(size, static_cast<char>('a' + size % 26));
    file.write(some);
    plain.write(some);
    bytes += some;
  }
  CHECK(file.sha256().empty());
  file.complete();
  CHECK(file.sha256() == sha256(bytes));
  file.publish();
  CHECK(read_file(folder.file("out.ngc")) == bytes);
  CHECK(file.sha256() == sha256(bytes));
  plain.publish();
  CHECK(plain.sha256().empty());
}

TEST_CASE("files that are published together get their names in order, up to the first failure") {
  const Folder folder;
  FileWriter a(folder.file("a.ngc")), b(folder.file("b.ngc")), c(folder.file("c.ngc"));
  for (FileWriter* file : {&a, &b, &c}) file->write("new");
  std::filesystem::create_directories(folder.file("b.ngc"));  // a file cannot take the name of a folder
  CHECK_THROWS_AS(FileWriter::publish_files({&a, &b, &c}), InputError);
  CHECK(read_file(folder.file("a.ngc")) == "new");
  CHECK(!std::filesystem::exists(folder.file("c.ngc")));
}

TEST_CASE("a device receives no bytes before publication, and its errors appear then") {
  if (!std::filesystem::exists("/dev/full")) return;
  FileWriter full("/dev/full");
  CHECK(full.is_stream());
  full.write("x");
  CHECK_NOTHROW(full.complete());
  CHECK_THROWS_AS(full.publish(), InputError);
}

TEST_CASE("a file is read in portions, and again from its beginning") {
  const Folder folder;
  write_file(folder.file("in.ngc"), "0123456789");
  FileReader file(folder.file("in.ngc"));
  std::string bytes = "<";
  CHECK(file.append(bytes, 4) == 4);
  CHECK(file.append(bytes, 100) == 6);
  CHECK(file.append(bytes, 100) == 0);
  CHECK(bytes == "<0123456789");
  file.rewind();
  bytes.clear();
  CHECK(file.append(bytes, 2) == 2);
  CHECK(sha256(file) == sha256("0123456789"));
  CHECK(file.append(bytes, 2) == 2);
  CHECK(bytes == "0101");
}

TEST_CASE("a pipe is read as often as a file") {
  const Folder folder;
  const std::string path = folder.file("pipe");
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  std::thread writer([&] {
    const int fd = ::open(path.c_str(), O_WRONLY);
    CHECK(::write(fd, "G0 X1\n", 6) == 6);
    ::close(fd);
  });
  FileReader file(path);
  writer.join();
  for (int time = 0; time < 2; ++time, file.rewind()) {
    std::string bytes;
    while (file.append(bytes, 4) > 0) {
    }
    CHECK(bytes == "G0 X1\n");
  }
}
