#include "reference_data.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "counterflex/geometry/types.hpp"

namespace counterflex::test {
namespace {

using Json = nlohmann::json;

const std::string data_folder = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/";

Eigen::VectorXd vector(const Json& list, double unit) {
  const auto numbers = list.get<std::vector<double>>();
  return unit * Eigen::VectorXd::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

std::optional<Eigen::VectorXd> optional_vector(const Json& table, const char* key, double unit) {
  if (!table.contains(key)) return std::nullopt;
  return vector(table.at(key), unit);
}

std::optional<Vector3> optional_vector3(const Json& table, const char* key, double unit) {
  const auto found = optional_vector(table, key, unit);
  if (!found) return std::nullopt;
  if (found->size() != 3) throw std::runtime_error(std::string(key) + " does not have three entries");
  return Vector3(*found);
}

// Actuators all move along, or all about, their axes in these machines.
std::optional<Eigen::VectorXd> actuators(const Json& table) {
  const auto lengths = optional_vector(table, "rho_mm", mm);
  return lengths ? lengths : optional_vector(table, "rho_deg", deg);
}

std::optional<ExpectedState> state(const Json& reference, const char* key) {
  if (!reference.contains(key)) return std::nullopt;
  const Json& table = reference.at(key);
  ExpectedState result{
      optional_vector3(table, "dp_mm", mm), optional_vector3(table, "drot_deg", deg), {}, {}, {}};
  if (table.contains("chain_wrenches_N_Nm"))
    for (const Json& wrench : table.at("chain_wrenches_N_Nm"))
      result.chain_wrenches.emplace_back(vector(wrench, 1));
  result.compliance_loads = optional_vector(table, "compliance_loads_N_Nm", 1);
  if (table.contains("springs"))
    for (const Json& spring : table.at("springs"))
      result.springs.push_back(
          (Vector6() << vector(spring.at("translation_mm"), mm), vector(spring.at("rotation_deg"), deg))
              .finished());
  return result;
}

std::optional<ExpectedCompensation> compensation(const Json& reference, const char* key) {
  if (!reference.contains(key)) return std::nullopt;
  const Json& table = reference.at(key);
  return ExpectedCompensation{actuators(table).value(), optional_vector3(table, "correction_mm", mm),
                              optional_vector3(table, "correction_deg", deg),
                              optional_vector3(table, "drot_deg", deg)};
}

ReferenceCase read_case(const Json& table) {
  ReferenceCase result;
  result.id = table.at("id");
  result.machine = table.at("machine");
  result.X_MT.p = vector(table.at("target").at("xyz_mm"), mm);
  result.X_MT.R = from_rpy(optional_vector3(table.at("target"), "rpy_deg", deg).value_or(Vector3::Zero()));
  result.tool = optional_vector3(table, "tool_mm", mm);
  result.wrench = vector(table.at("wrench_N_Nm"), 1);
  result.error_scale = table.value("error_scale", 1.0);
  result.rho = actuators(table);
  result.unloaded = state(table, "unloaded");
  result.loaded = state(table, "loaded");
  result.loaded_perfect = state(table, "loaded_perfect");
  result.compensated = compensation(table, "compensated");
  result.compensated_perfect = compensation(table, "compensated_perfect");
  return result;
}

}  // namespace

std::vector<ReferenceCase> reference_cases(const std::string& name) {
  std::ifstream file(data_folder + name + ".json");
  std::vector<ReferenceCase> cases;
  const Json content = Json::parse(file);
  for (const Json& table : content.at("cases")) cases.push_back(read_case(table));
  return cases;
}

std::string reference_machine_file(const std::string& machine) {
  return data_folder + machine + ".toml";
}

}  // namespace counterflex::test
