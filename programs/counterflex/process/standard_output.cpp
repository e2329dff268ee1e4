#include "process/standard_output.hpp"

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex::cli {

void write_result(std::string_view text) {
  write_file("-", lines_without_controls(text));
}

void write_painted_result(std::string_view text) {
  write_file("-", text);
}

}  // namespace counterflex::cli
