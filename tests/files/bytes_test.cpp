#include "counterflex/files/bytes.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/sha256.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("values come back from their bytes in the order in which they were put") {
  std::string bytes;
  put(-0.0, bytes);
  put(7, bytes);
  put(true, bytes);
  put(std::string_view("a\0b", 3), bytes);
  put(std::size_t{1} << 40, bytes);
  BytesIn in(bytes);
  CHECK(std::signbit(in.get<double>()));
  CHECK(in.get<int>() == 7);
  CHECK(in.get<bool>());
  CHECK(in.get_text() == std::string_view("a\0b", 3));
  CHECK_FALSE(in.is_complete());
  CHECK(in.get<std::size_t>() == std::size_t{1} << 40);
  CHECK(in.is_complete());
}

TEST_CASE("bytes that are too few give nothing, and are not complete") {
  std::string bytes;
  put(std::string_view("text"), bytes);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    BytesIn in(std::string_view(bytes).substr(0, length));
    CHECK(in.get_text().empty());
    CHECK(in.has_failed());
    CHECK(in.get<int>() == 0);
    CHECK_FALSE(in.is_complete());
  }
}

TEST_CASE("a count is never larger than there is room for") {
  std::string bytes;
  put(std::size_t{3}, bytes);
  bytes += "123456";
  CHECK(BytesIn(bytes).get_count(2) == 3);
  CHECK(BytesIn(bytes).get_count(3) == 0);
  std::string huge;
  put(~std::size_t{0}, huge);
  huge += "more";
  BytesIn in(huge);
  CHECK(in.get_count(8) == 0);
  CHECK(in.has_failed());
}

TEST_CASE("SHA-256 of portions is that of the whole") {
  Sha256 hash;
  hash.add("ab");
  hash.add("");
  hash.add("c");
  const std::string digits = hash.digits();
  CHECK(digits == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(digits == sha256("abc"));
}

TEST_CASE("the size of a file is known wherever it is being read") {
  const Folder folder;
  write_file(folder.file("a"), std::string(1000, 'x'));
  FileReader file(folder.file("a"));
  CHECK(file.size() == 1000);
  std::string bytes;
  file.append(bytes, 10);
  CHECK(file.size() == 1000);
  CHECK(FileReader::of_bytes("abc").size() == 3);
}
