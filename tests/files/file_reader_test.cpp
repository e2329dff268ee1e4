#include "counterflex/files/file_reader.hpp"

#include <doctest/doctest.h>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string in_portions(FileReader& reader, std::size_t most) {
  std::string bytes;
  for (std::size_t count = 1; count > 0;) {
    const std::size_t before = bytes.size();
    count = reader.append(bytes, most);
    CHECK(bytes.size() == before + count);
    CHECK(count <= most);
  }
  return bytes;
}

std::optional<ErrorKind> change_of(const FileReader& reader) {
  try {
    reader.refuse_change();
  } catch (const InputError& error) {
    return error.kind();
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("a file is read in portions, and again from its beginning") {
  const Folder folder;
  const std::string bytes = "G1 X1\n" + std::string(1000, 'y') + "\nend";
  write_file(folder.file("a.ngc"), bytes);
  FileReader from_file(folder.file("a.ngc")), from_memory = FileReader::of_bytes(bytes);
  for (FileReader* reader : {&from_file, &from_memory}) {
    CHECK(in_portions(*reader, 7) == bytes);
    CHECK(in_portions(*reader, 7).empty());
    reader->rewind();
    CHECK(in_portions(*reader, 5000) == bytes);
    CHECK(sha256(*reader) == sha256(bytes));
    CHECK(in_portions(*reader, 64) == bytes);
  }
}

TEST_CASE("a hash computed while reading is that of the whole file, after any earlier reads") {
  const std::string bytes = "G1 X1\n" + std::string(100000, 'y') + "\nend";
  for (const std::size_t first : {0, 1, 7, 5000, 200000})
    for (const std::size_t again : {0, 3, 9000, 200000}) {
      CAPTURE(first);
      CAPTURE(again);
      FileReader reader = FileReader::of_bytes(bytes);
      reader.hash_along();
      for (const std::size_t most : {first, again}) {
        std::string some;
        reader.append(some, most);
        reader.append(some, most / 2);
        reader.rewind();
      }
      CHECK(in_portions(reader, 4096) == bytes);
      CHECK(sha256(reader) == sha256(bytes));
      CHECK(in_portions(reader, 4096) == bytes);
    }
  FileReader late = FileReader::of_bytes(bytes);
  std::string some;
  late.append(some, 100);
  late.hash_along();
  late.append(some, 100);
  CHECK(sha256(late) == sha256(bytes));
  CHECK(sha256(late) == sha256(bytes));
  FileReader empty = FileReader::of_bytes("");
  empty.hash_along();
  CHECK(sha256(empty) == sha256(std::string_view()));
}

TEST_CASE("a file that changes while it is read is refused") {
  const Folder folder;
  write_file(folder.file("a.ngc"), "G1 X1\n");
  const FileReader replaced(folder.file("a.ngc"));
  CHECK(change_of(replaced) == std::nullopt);
  CHECK(change_of(FileReader::of_bytes("G1")) == std::nullopt);
  std::filesystem::resize_file(folder.file("a.ngc"), 3);
  CHECK(change_of(replaced) == ErrorKind::transient_io);
}

TEST_CASE("replacing a file while it is read does not affect the reader") {
  const Folder folder;
  write_file(folder.file("a.ngc"), "G1 X1\n");
  FileReader reader(folder.file("a.ngc"));
  write_file(folder.file("a.ngc"), "G1 X2\n");
  CHECK(change_of(reader) == std::nullopt);
  CHECK(in_portions(reader, 100) == "G1 X1\n");
}

TEST_CASE("unpublished files can be removed from a signal handler") {
  const Folder folder;
  FileWriter published(folder.file("a.ngc"));
  published.write("G1 X1\n");
  published.publish();
  FileWriter writer(folder.file("b.ngc"));
  writer.write(std::string(1 << 20, 'x'));
  CHECK(folder.count() == 2);
  remove_unpublished();
  CHECK(folder.count() == 1);
  CHECK(read_file(folder.file("a.ngc")) == "G1 X1\n");
}
