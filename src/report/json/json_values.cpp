#include "report/json/json_values.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace counterflex {

namespace {

constexpr int deepest = 100;  // a page's data have seven levels

/// The parser's message after its place: "syntax error while parsing value - ...".
std::string parser_message(const std::string& what) {
  const std::size_t column = what.find("column ");
  const std::size_t colon = what.find(": ", column == std::string::npos ? 0 : column);
  return colon == std::string::npos ? what : what.substr(colon + 2);
}

/// The end of the string that begins at `quote`, its closing quote.
std::size_t end_of_string(std::string_view text, std::size_t quote) {
  std::size_t i = quote + 1;
  while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
  return i;
}

/// The place where lists and objects are nested too deep for the stack, or the end of the text.
std::size_t too_deep(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"')
      i = end_of_string(text, i);
    else if ((c == '[' || c == '{') && ++depth > deepest)
      return i;
    else if (c == ']' || c == '}')
      --depth;
  }
  return text.size();
}

/// The place of the number in the parser's message `what` ("number overflow parsing '1e999'"), which has no
/// byte offset. Without a number: the beginning of the text.
std::size_t place_of_number(std::string_view text, std::string_view what) {
  const std::size_t open = what.find('\''), close = what.rfind('\'');
  if (open == close) return 0;
  const std::string_view number = what.substr(open + 1, close - open - 1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"')
      i = end_of_string(text, i);
    else if (text.substr(i).starts_with(number))
      return i;
  }
  return 0;
}

/// Removes "[json.exception.out_of_range.406] ".
std::string without_tag(const std::string& what) {
  const std::size_t end = what.find("] ");
  return end == std::string::npos ? what : what.substr(end + 2);
}

}  // namespace

Location place_of(std::string_view text, std::size_t offset, const std::string& file) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t last_break = before.rfind('\n');
  const std::size_t start = last_break == std::string_view::npos ? 0 : last_break + 1;
  return {file, static_cast<int>(line), static_cast<int>(before.size() - start) + 1};
}

Json parse_json(std::string_view text, std::string_view whole, std::size_t offset, const std::string& file,
                ErrorKind kind) {
  if (const std::size_t at = too_deep(text); at < text.size())
    throw InputError(kind, place_of(whole, offset + at, file),
                     fmt::format("lists and objects are nested more than {} deep", deepest));
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;  // it counts from 1
    throw InputError(kind, place_of(whole, offset + byte, file),
                     "is not JSON: " + parser_message(error.what()));
  } catch (const Json::exception& error) {  // a number beyond the range of double
    throw InputError(kind, place_of(whole, offset + place_of_number(text, error.what()), file),
                     "cannot be read: " + without_tag(error.what()));
  }
}

std::string plain_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return fmt::format("{}", value.get<double>());  // 4, not 4.0
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const Json* JsonSource::find(const std::string& pointer) const {
  const Json::json_pointer at(pointer);
  if (!document.contains(at)) return nullptr;
  const Json& value = document.at(at);
  return value.is_null() ? nullptr : &value;
}

void JsonSource::refuse(const std::string& pointer, const Json& value, const char* wanted) const {
  constexpr std::size_t most = 60;
  std::string seen = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (seen.size() > most) seen = seen.substr(0, most) + "...";
  throw InputError(kind, {file}, fmt::format("{} is {}; {} or null is allowed", pointer, seen, wanted));
}

std::optional<double> JsonSource::number(const std::string& pointer) const {
  const Json* value = find(pointer);
  if (value == nullptr) return std::nullopt;
  if (!value->is_number()) refuse(pointer, *value, "a number");
  return value->get<double>();
}

std::string JsonSource::text(const std::string& pointer) const {
  const Json* value = find(pointer);
  if (value == nullptr) return "";
  if (!value->is_string()) refuse(pointer, *value, "a text");
  return value->get<std::string>();
}

const Json* JsonSource::object(const std::string& pointer) const {
  const Json* value = find(pointer);
  if (value != nullptr && !value->is_object()) refuse(pointer, *value, "an object");
  return value;
}

const Json* JsonSource::list(const std::string& pointer) const {
  const Json* value = find(pointer);
  if (value != nullptr && !value->is_array()) refuse(pointer, *value, "a list");
  return value;
}

}  // namespace counterflex
