#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/report/identification.hpp"
#include "report/json/json_values.hpp"

namespace counterflex {
namespace {

constexpr std::string_view schema = "counterflex-identification 1";
constexpr double same_value = 0.01;  // of a standard deviation: machine files have rounded values

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw InputError(ErrorKind::machine_or_force, {file}, what);
}

const Parameter& parameter_named(const std::vector<Parameter>& all, const std::string& name,
                                 const std::string& file) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
  if (found == all.end())
    fail(file,
         fmt::format("the machine file has no parameter \"{}\"; use the machine file that the same run wrote",
                     without_controls(name)));
  return *found;
}

}  // namespace

KnownParameters read_covariance(std::string_view text, const std::string& file, const Machine& machine) {
  const Json document = parse_json(text, text, 0, file, ErrorKind::machine_or_force);
  const JsonSource source{document, file, ErrorKind::machine_or_force};
  if (source.text("/schema") != schema)
    fail(file,
         fmt::format("the schema is \"{}\"; it must be \"{}\": give the STEM.json that identify --report "
                     "wrote",
                     without_controls(source.text("/schema")), schema));
  const Json *listed = source.list("/parameters"), *rows = source.list("/covariance");
  if (listed == nullptr || rows == nullptr || rows->size() != listed->size())
    fail(file, "the document needs parameters, and a covariance with one row for each of them");
  const std::vector<Parameter> all = parameters(machine);
  const auto n = static_cast<Eigen::Index>(listed->size());
  KnownParameters prior;
  prior.covariance.resize(n, n);
  std::vector<double> units;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string at = fmt::format("/parameters/{}", i);
    const std::string name = source.text(at + "/name");
    const Parameter& parameter = parameter_named(all, name, file);
    const double value = source.number(at + "/value").value_or(NAN),
                 sigma = source.number(at + "/sigma").value_or(NAN);
    if (!(std::abs(parameter.value / parameter.unit - value) <= same_value * sigma))
      fail(file,
           fmt::format("{} is {:.9g} here and {:.9g} in the machine file; use the machine file that the same "
                       "run wrote",
                       name, value, parameter.value / parameter.unit));
    prior.names.push_back(name);
    units.push_back(parameter.unit);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      prior.covariance(i, j) = source.number(fmt::format("/covariance/{}/{}", i, j)).value_or(NAN) *
                               units[static_cast<std::size_t>(i)] * units[static_cast<std::size_t>(j)];
  if (!prior.covariance.allFinite()) fail(file, "the covariance lacks numbers");
  if (!is_covariance(prior.covariance)) fail(file, "the covariance must be symmetric and positive definite");
  return prior;
}

}  // namespace counterflex
