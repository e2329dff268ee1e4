#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/identify/identify.hpp"
#include "toml/source.hpp"

namespace counterflex {
namespace {

/// A basic string of TOML.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// `value` with as many digits as its deviation makes sense of, and three more.
std::string number(double value, double sigma) {
  if (std::abs(value) <= 1e-6 * sigma) return "0.0";
  const int digits = sigma > 0 ? static_cast<int>(std::floor(std::log10(std::abs(value) / sigma))) + 4 : 9;
  std::string text = fmt::format("{:.{}g}", value, std::clamp(digits, 4, 15));
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

const ParameterStatement* statement_of(const IdentifiedParameter& parameter, const Machine& machine) {
  for (const ParameterStatement& stated : machine.parameters)
    if (stated.name == parameter.name) return &stated;
  return nullptr;
}

std::string_view source_of(const IdentifiedParameter& parameter, const ParameterStatement* stated) {
  if (parameter.is_identified) return "measured";
  if (stated == nullptr) return "prior";
  return stated->source == NumberSource::measured    ? "measured"
         : stated->source == NumberSource::catalogue ? "catalogue"
                                                     : "prior";
}

/// Where the number is from: a parameter that is not identified keeps its note.
std::string note_of(const IdentifiedParameter& parameter, const ParameterStatement* stated,
                    const std::string& files) {
  if (parameter.is_identified) return "identified from " + files;
  const std::string free = "not identified by " + files;
  if (stated == nullptr || stated->note.empty()) return free;
  constexpr double same = 1e-3;  // of the prior deviation
  const bool has_moved = std::abs(parameter.value - parameter.before) > same * parameter.prior;
  return has_moved && !stated->note.ends_with(free) ? stated->note + "; " + free : stated->note;
}

std::string entry(const IdentifiedParameter& parameter, const Machine& machine, const std::string& files) {
  const ParameterStatement* stated = statement_of(parameter, machine);
  return fmt::format("{} = {{ value = {}, sigma = {:.3g}, source = \"{}\", note = {} }}",
                     quoted(parameter.name),
                     number(parameter.value / parameter.unit, parameter.sigma / parameter.unit),
                     parameter.sigma / parameter.unit, source_of(parameter, stated),
                     quoted(note_of(parameter, stated, files)));
}

/// Whether the machine file without a line of the parameter would have another value or deviation.
bool tells_more(const IdentifiedParameter& parameter) {
  constexpr double same_value = 1e-6, same_sigma = 1e-3;  // of the prior deviation
  return !parameter.is_default_prior ||
         std::abs(parameter.value - parameter.before) > same_value * parameter.prior ||
         parameter.sigma < (1 - same_sigma) * parameter.prior;
}

}  // namespace

std::string with_identified(std::string_view text, const std::string& file, const Identification& found,
                            const std::string& files) {
  const toml_file::Source source(text, file);
  const toml::table document = source.parse();
  std::map<std::string, std::string> entries;
  for (const IdentifiedParameter& parameter : found.parameters)
    if (tells_more(parameter)) entries[parameter.name] = entry(parameter, found.machine, files);
  // Lines of entries that are there are replaced; an inline table is one line.
  std::map<int, std::string> replaced;
  int header = 0;
  const toml::node* node = document.get("parameters");
  if (node != nullptr) {
    if (node->as_table()->is_inline())
      source.fail(*node, "[parameters] is an inline table; write it as a table with one entry a line");
    header = source.at(node->source()).line;
    for (const auto& [key, value] : *node->as_table()) {
      const auto identified = entries.find(std::string(key.str()));
      if (identified == entries.end()) continue;
      const int line = source.at(key.source()).line;
      if (!value.is_table() || !value.as_table()->is_inline())
        source.fail(key, fmt::format("the entry of \"{}\" is not one line; write it as \"{}\" = {{ ... }}",
                                     key.str(), key.str()));
      replaced[line] = identified->second;
      entries.erase(identified);
    }
  }
  const bool has_crlf = text.find("\r\n") != std::string_view::npos;
  const std::string end = has_crlf ? "\r\n" : "\n";
  std::string added;
  for (const IdentifiedParameter& parameter : found.parameters)
    if (const auto left = entries.find(parameter.name); left != entries.end()) added += left->second + end;
  std::string out;
  int line = 0;
  while (!text.empty()) {
    const std::string_view content = csv::take_line(text);
    ++line;
    const auto found_line = replaced.find(line);
    out += found_line == replaced.end() ? std::string(content) : found_line->second;
    out += end;
    if (line == header) out += added;
  }
  if (header == 0 && !added.empty()) out += end + "[parameters]" + end + added;
  return out;
}

}  // namespace counterflex
