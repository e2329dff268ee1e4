#include <fmt/core.h>

#include <algorithm>

#include "report/comparison/comparison_parts.hpp"

namespace counterflex {

namespace {

/// The keys of an object that may be missing in one of the reports: those of the first, then others of the
/// second.
std::vector<std::string> keys_of_both(const TwoReports& reports, const std::string& pointer) {
  std::vector<std::string> keys;
  for (const JsonSource& report : reports)
    if (const Json* object = report.object(pointer))
      for (const auto& item : object->items())
        if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) keys.push_back(item.key());
  return keys;
}

/// The JSON pointer to `key`, which may have any characters.
std::string below(const std::string& pointer, std::string key) {
  const auto replace = [&](char wanted, std::string_view with) {
    for (std::size_t i = key.find(wanted); i != std::string::npos; i = key.find(wanted, i + with.size()))
      key.replace(i, 1, with);
  };
  replace('~', "~0");
  replace('/', "~1");
  return pointer + "/" + key;
}

/// "groove.ngc (8495724b9db4f12b)".
std::string file_and_hash(const JsonSource& report, const std::string& pointer) {
  constexpr std::size_t shown_digits = 16;  // as the header of a corrected program
  if (report.object(pointer) == nullptr) return "";
  return fmt::format("{} ({})", report.text(pointer + "/path"),
                     report.text(pointer + "/sha256").substr(0, shown_digits));
}

std::string text_at(const JsonSource& report, const std::string& pointer) {
  const Json* value = report.find(pointer);
  return value == nullptr ? "" : plain_text(*value);
}

void add_difference(std::string what, std::string a, std::string b, std::vector<RunDifference>& list) {
  if (a != b) list.push_back({std::move(what), {std::move(a), std::move(b)}});
}

void add_inputs(const TwoReports& reports, std::vector<RunDifference>& list) {
  const std::vector<std::string> same = same_inputs(reports);
  for (const std::string& role : keys_of_both(reports, "/inputs")) {
    const std::string at = below("/inputs", role);
    if (std::find(same.begin(), same.end(), role) == same.end())
      add_difference("file: " + role, file_and_hash(reports[0], at), file_and_hash(reports[1], at), list);
  }
}

void add_each(const TwoReports& reports, const std::string& pointer, const std::string& prefix,
              std::vector<RunDifference>& list) {
  for (const std::string& key : keys_of_both(reports, pointer)) {
    const std::string at = below(pointer, key);
    add_difference(prefix + key, text_at(reports[0], at), text_at(reports[1], at), list);
  }
}

}  // namespace

std::vector<std::string> same_inputs(const TwoReports& reports) {
  std::vector<std::string> same;
  for (const std::string& role : keys_of_both(reports, "/inputs")) {
    const std::string at = below("/inputs", role) + "/sha256";
    const std::string hash = reports[0].text(at);
    if (!hash.empty() && hash == reports[1].text(at)) same.push_back(role);
  }
  return same;
}

std::vector<RunDifference> run_differences(const TwoReports& reports) {
  std::vector<RunDifference> list;
  for (const char* key : {"tool", "command", "machine"}) {
    const std::string at = fmt::format("/{}", key);
    add_difference(key, reports[0].text(at), reports[1].text(at), list);
  }
  add_inputs(reports, list);
  add_each(reports, "/options", "option: ", list);
  add_each(reports, "/assumptions", "assumption: ", list);
  return list;
}

}  // namespace counterflex
