#include "counterflex/files/files.hpp"

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/file_writer.hpp"

namespace counterflex {

std::string read_file(const std::string& path) {
  FileReader file(path);
  std::string bytes;
  while (file.append(bytes, 1 << 18) > 0) {
  }
  return bytes;
}

void write_file(const std::string& path, std::string_view bytes) {
  FileWriter file(path);
  file.write(bytes);
  file.publish();
}

}  // namespace counterflex
