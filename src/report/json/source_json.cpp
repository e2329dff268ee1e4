#include <filesystem>

#include "counterflex/files/text.hpp"
#include "counterflex/report/page.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {
namespace {

/// The whole program; null if it is too long for a page.
Json text_of(FileReader& program) {
  program.rewind();
  std::string text;
  while (text.size() <= longest_program_text &&
         program.append(text, longest_program_text + 1 - text.size()) > 0) {
  }
  if (text.size() > longest_program_text) return nullptr;
  std::erase(text, '\r');
  return lines_without_controls(text);
}

Json absolute_path(const std::string& path) {
  if (path.empty() || path == "-") return nullptr;
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path, error);
  return error ? Json(path) : Json(absolute.lexically_normal().generic_string());
}

}  // namespace

std::string source_json(FileReader& program, const RunReport& report) {
  const Json document = {{"text", text_of(program)}, {"output", absolute_path(report.facts.output)}};
  return on_one_line(document);
}

}  // namespace counterflex
