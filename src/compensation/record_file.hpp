#pragma once
/// A file of recorded windows: a line that names its format, a mark of the order of bytes, what the run is,
/// for each window the length of its record and the record, a length of zero, and the SHA-256 of all that.
#include <optional>
#include <string>
#include <string_view>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/sha256.hpp"

namespace counterflex {

class RecordWriter {
 public:
  RecordWriter(const std::string& path, const std::string& run);
  void add(std::string_view record);
  FileWriter finish();  ///< nothing can be added any more

 private:
  void write(std::string_view bytes);

  FileWriter file_;
  Sha256 hash_;
};

/// Throws `InputError` (Exit::machine_or_force) where a file is not one of records, damaged, or of another
/// run.
void check_record_file(const std::string& path, const std::string& run);

/// The records of a file that has been checked, one after the other.
class RecordReader {
 public:
  RecordReader(const std::string& path, const std::string& run);

  /// Nothing at the end.
  std::optional<std::string> next();

 private:
  std::string take(std::size_t count);

  std::string path_;
  FileReader file_;
  std::string ahead_;      // read, and not taken yet
  std::size_t begin_ = 0;  // of what has not been taken
};

}  // namespace counterflex
