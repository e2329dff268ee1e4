#include "machine/read/read_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/machine/parameters.hpp"
#include "toml/fields.hpp"
#include "toml/suggest.hpp"

namespace counterflex::toml_file {
namespace {

const std::vector<std::string_view> sources = {"measured", "catalogue", "prior"};

NumberSource read_number_source(const toml::node& node, const Source& source) {
  const std::string text = as_choice(node, "source", sources, source);
  return text == sources[0]   ? NumberSource::measured
         : text == sources[1] ? NumberSource::catalogue
                              : NumberSource::prior;
}

/// The standard deviation (SI) that the entry gives. `value` (SI) is the parameter's.
std::optional<double> read_sigma(const toml::table& table, const Parameter& parameter, double value,
                                 const Source& source) {
  const std::string_view form = one_of(table, {"sigma", "prior_percent"}, parameter.name, source);
  if (form.empty()) return {};
  const toml::node& node = *table.get(form);
  if (form == "sigma") return as_not_negative(node, {form}, {source}) * parameter.unit;
  if (value == 0)
    source.fail(node, fmt::format("prior_percent of \"{}\", whose value is 0, is 0; give sigma instead",
                                  parameter.name));
  return as_positive(node, {form}, {source}) / 100 * std::abs(value);
}

double read_value(const toml::node& node, const Parameter& parameter, const Source& source) {
  const bool is_positive =
      parameter.kind == ParameterKind::compliance || parameter.kind == ParameterKind::mass;
  const double value = is_positive ? as_positive(node, {"value"}, {source})
                       : parameter.kind == ParameterKind::reversal
                           ? as_not_negative(node, {"value"}, {source})
                           : as_number(node, {"value"}, {source});
  return value * parameter.unit;
}

std::size_t find_parameter(const toml::key& key, const std::vector<Parameter>& all, const Source& source) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == key.str(); });
  if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
  std::vector<std::string_view> known;
  for (const Parameter& parameter : all) known.push_back(parameter.name);
  const std::string_view meant = nearest(key.str(), known);
  source.fail(key, fmt::format("the machine has no parameter \"{}\"{}; `check --parameters` lists them",
                               key.str(), meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant)));
}

}  // namespace

void read_parameters(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("parameters");
  if (node == nullptr) return;
  const std::vector<Parameter> all = parameters(machine);
  std::vector<double> values;
  for (const Parameter& parameter : all) values.push_back(parameter.value);
  std::vector<std::pair<toml::source_position, ParameterStatement>> statements;
  for (const auto& [key, entry] : as_table(*node, "parameters", source)) {
    const std::size_t index = find_parameter(key, all, source);
    const Parameter& parameter = all[index];
    const toml::table& table = as_table(entry, parameter.name, source);
    check_keys(table, {"value", "sigma", "prior_percent", "source", "note"}, "a parameter", source);
    if (const toml::node* value = table.get("value")) values[index] = read_value(*value, parameter, source);
    ParameterStatement statement;
    statement.name = parameter.name;
    statement.source = read_number_source(required(table, "source", "a parameter", entry, source), source);
    statement.sigma = read_sigma(table, parameter, values[index], source);
    if (const toml::node* note = table.get("note"))
      statement.note = without_controls(as_text(*note, "note", source));
    statements.emplace_back(key.source().begin, std::move(statement));
  }
  std::sort(statements.begin(), statements.end(), [](const auto& a, const auto& b) {
    return a.first.line != b.first.line ? a.first.line < b.first.line : a.first.column < b.first.column;
  });
  for (auto& [at, statement] : statements) machine.parameters.push_back(std::move(statement));
  machine = with_parameters(machine, values);
}

}  // namespace counterflex::toml_file
