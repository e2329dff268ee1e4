#include "counterflex/files/input_error.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

std::string located(const Location& where, const std::string& message) {
  if (where.file.empty()) return fmt::format("error: {}", message);
  if (where.line == 0) return fmt::format("{}: error: {}", where.file, message);
  if (where.column == 0) return fmt::format("{}:{}: error: {}", where.file, where.line, message);
  return fmt::format("{}:{}:{}: error: {}", where.file, where.line, where.column, message);
}

}  // namespace

InputError::InputError(ErrorKind kind, const Location& where, const std::string& message)
    : std::runtime_error(without_controls(located(where, message))), kind_(kind), where_(where) {}

}  // namespace counterflex
