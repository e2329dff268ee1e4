#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/check.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/spectrum.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/report/machine_drawing.hpp"
#include "counterflex/statics/chain.hpp"
#include "process/read_input.hpp"
#include "run/run_files.hpp"
#include "run/sanity.hpp"

namespace counterflex::cli {
namespace {

/// A machine at its home.
struct HomeFacts {
  Eigen::VectorXd shown;  ///< values of the actuators
  Pose X_MT;
  double actuator_condition = 0;          ///< 0: no actuators
  Status status = Status::not_converged;  ///< of the machine at home without load
  Vector6 deviation = Vector6::Zero();    ///< meaningful when converged
  double static_condition = 0, stability = 0;
  std::vector<int>
      spring_directions;  ///< by chain: how many of the end's six directions its springs and compliances span
};

/// Columns of elements that deflect under load: springs, compliances, passive joints with springs, and groups
/// with any of these.
bool yields(const Part& part, const Series& series) {
  if (part.kind == PartKind::spring || part.kind == PartKind::compliance) return true;
  if (part.kind == PartKind::passive) return part.k > 0;
  if (part.kind != PartKind::group) return false;
  for (const Series& branch : series.groups[static_cast<std::size_t>(part.group)].branches)
    for (const Part& inner : branch.parts)
      if (yields(inner, branch)) return true;
  return false;
}

int columns_of(const Part& part) {
  return part.kind == PartKind::spring || part.kind == PartKind::group ? 6 : 1;
}

int spring_directions(const Model& model, std::size_t chain, StaticsWork& work) {
  const Series& series = model.mechanism.chains[chain];
  Eigen::MatrixXd J = chain_jacobian(model, chain, model.home.chains[chain], nominal_stage, work);
  J.topRows<3>() /= model.mechanism.length;
  std::vector<int> columns;
  for (const Part& part : series.parts)
    if (yields(part, series))
      for (int i = 0; i < columns_of(part); ++i) columns.push_back(part.column + i);
  if (columns.empty()) return 0;
  const Eigen::VectorXd sigma = singular_values(J(Eigen::all, columns));
  return sigma[0] > 0 ? static_cast<int>((sigma.array() >= 1e-9 * sigma[0]).count()) : 0;
}

HomeFacts look_at_home(const Model& model) {
  HomeFacts home;
  StaticsWork work(model.mechanism);
  home.shown = shown_values(model.mechanism.shown, actuator_values(model.mechanism, model.home));
  home.X_MT = tip(model.mechanism, model.home);
  if (home.shown.size() > 0) home.actuator_condition = actuator_jacobian(model, model.home).condition;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
    home.spring_directions.push_back(spring_directions(model, i, work));
  const Equilibrium actual = solve_forward(model, model.home, Load{}, Stage{}, work);
  home.status = actual.status;
  if (actual.status != Status::converged) return home;
  home.deviation = deviation(tip(model.mechanism, actual.configuration), home.X_MT);
  home.static_condition = static_condition(model, actual.configuration, Load{}, Stage{}, work);
  home.stability = stability(model, actual.configuration, Load{}, Stage{}, work);
  return home;
}

struct Value {
  double number;
  const char* unit;
};

Value in_unit(double value, JointKind kind) {
  const bool length = kind == JointKind::prismatic;
  return {rounded(value / (length ? mm : deg), 9), length ? "mm" : "deg"};  // without numerical noise
}

std::vector<std::string> notes_of(const Machine& machine, const Model& model, const HomeFacts& home) {
  std::vector<std::string> notes = structural_notes(machine);
  for (std::size_t i = 0; i < home.spring_directions.size(); ++i)
    if (home.spring_directions[i] < 6)
      notes.push_back(fmt::format("chain {}: its springs span {} of the six directions of its end at home",
                                  model.mechanism.chains[i].name, home.spring_directions[i]));
  for (Eigen::Index i = 0; i < home.shown.size(); ++i) {
    const Travel& travel = model.mechanism.travel[static_cast<std::size_t>(i)];
    if (home.shown[i] >= travel.min && home.shown[i] <= travel.max) continue;
    const Value value = in_unit(home.shown[i], travel.kind);
    notes.push_back(
        fmt::format("actuator {} is outside its travel at home: {:.6g} {}", i + 1, value.number, value.unit));
  }
  if (home.status != Status::converged)
    notes.push_back(fmt::format("at home, without load, the machine is {}", to_string(home.status)));
  return notes;
}

std::string position_text(const Vector3& p) {
  const auto shown = [](double x) { return rounded(x / mm, 9); };  // without numerical noise
  return fmt::format("{:.6g}, {:.6g}, {:.6g} mm", shown(p.x()), shown(p.y()), shown(p.z()));
}

std::string weights_text(const Machine& machine) {
  if (!weighs(machine)) return "";
  return machine.gravity.true_at_home ? ", under its weight, with the control's zero set here"
                                      : ", under its weight";
}

std::string home_text(const Machine& machine, const Model& model, const HomeFacts& home) {
  std::string text = "\nat home\n";
  const auto line = [&](std::string_view label, const std::string& value) {
    text += fmt::format("  {:<20} {}\n", label, value);
  };
  line("closures", model.mechanism.chains.size() > 1 || model.home_gap > 0
                       ? fmt::format("met within {:.1g} (m and rad)", model.home_gap)
                       : "none");
  line("tip", position_text(home.X_MT.p));
  for (Eigen::Index i = 0; i < home.shown.size(); ++i) {
    const Value value = in_unit(home.shown[i], model.mechanism.travel[static_cast<std::size_t>(i)].kind);
    line(fmt::format("actuator {}", i + 1), fmt::format("{:.6g} {}", value.number, value.unit));
  }
  if (home.shown.size() > 0)
    line("condition", fmt::format("{:.3g} from actuators to tip", home.actuator_condition));
  if (home.status != Status::converged) return text;
  line("", fmt::format("{:.3g} of the static system", home.static_condition));
  line("stability",
       fmt::format("stable: least eigenvalue {:.3g}, each coordinate scaled by its own stiffness",
                   home.stability));
  line("deviation",
       "tip off by " + position_text(home.deviation.head<3>()) + " without load" + weights_text(machine));
  return text;
}

nlohmann::ordered_json limit_json(double value, JointKind kind) {
  if (!std::isfinite(value)) return nullptr;
  return in_unit(value, kind).number;
}

nlohmann::ordered_json actuators_json(const Model& model, const HomeFacts& home) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < home.shown.size(); ++i) {
    const Travel& travel = model.mechanism.travel[static_cast<std::size_t>(i)];
    const Value value = in_unit(home.shown[i], travel.kind);
    list.push_back({{"unit", value.unit},
                    {"home", value.number},
                    {"min", limit_json(travel.min, travel.kind)},
                    {"max", limit_json(travel.max, travel.kind)}});
  }
  return list;
}

nlohmann::ordered_json load_limits_json(const LoadLimits& limits) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const LoadKind kind : load_kinds)
    if (limits[kind]) json[std::string(name_of(kind).key)] = rounded(*limits[kind] / name_of(kind).si, 9);
  return json;
}

nlohmann::ordered_json chains_json(const Machine& machine, const HomeFacts& home) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < machine.chains.size(); ++i) {
    const Freedoms count = freedoms(machine.chains[i]);
    list.push_back({{"name", machine.chains[i].name},
                    {"actuators", count.actuators},
                    {"passive_joints", count.passives},
                    {"elastic_coordinates", count.elastic},
                    {"spring_directions", home.spring_directions[i]}});
    if (!machine.load_limits.empty()) list.back()["limits"] = load_limits_json(machine.load_limits[i]);
  }
  return list;
}

nlohmann::ordered_json tools_json(const Machine& machine) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [number, tool] : machine.tools) {
    nlohmann::ordered_json row{{"number", number}, {"stiffness", stiffness_phrase(tool)}};
    if (tool.length) row["length_mm"] = rounded(*tool.length / mm, 9);
    if (!tool.yields.empty()) row["radial_N_per_um"] = rounded(radial_stiffness(tool) / N_per_um, 9);
    list.push_back(std::move(row));
  }
  return list;
}

nlohmann::ordered_json json_of(const Vector3& v, double unit) {
  return {v.x() / unit, v.y() / unit, v.z() / unit};
}

nlohmann::ordered_json home_json(const Model& model, const HomeFacts& home) {
  nlohmann::ordered_json json{{"closure_gap", model.home_gap},
                              {"tip_mm", json_of(home.X_MT.p, mm)},
                              {"rpy_deg", json_of(to_rpy(home.X_MT.R), deg)},
                              {"actuator_condition", home.actuator_condition},
                              {"status", to_string(home.status)}};
  if (home.status != Status::converged) return json;
  json["static_condition"] = home.static_condition;
  json["stability"] = home.stability;
  json["displacement_mm"] = json_of(home.deviation.head<3>(), mm);
  json["rotation_deg"] = json_of(home.deviation.tail<3>(), deg);
  return json;
}

nlohmann::ordered_json gravity_json(const Machine& machine) {
  nlohmann::ordered_json masses;
  for (const Chain& chain : machine.chains) masses[chain.name] = total_mass(chain);
  return {{"m_s2", json_of(machine.gravity.g, 1)},
          {"reference", machine.gravity.true_at_home ? "home" : "unloaded"},
          {"mass_kg", total_mass(machine)},
          {"mass_kg_by_chain", masses}};
}

nlohmann::ordered_json numbers_json(const Machine& machine) {
  const NumberSources sources = number_sources(machine);
  return {{"measured", sources.measured},
          {"catalogue", sources.catalogue},
          {"prior", sources.prior},
          {"unmeasured", is_unmeasured(machine)}};
}

/// What the file states about a parameter, if anything.
const ParameterStatement* statement_of(const Machine& machine, const Parameter& parameter) {
  const auto& all = machine.parameters;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& stated) { return stated.name == parameter.name; });
  return found == all.end() ? nullptr : &*found;
}

std::string_view name_of(NumberSource source) {
  return source == NumberSource::measured    ? "measured"
         : source == NumberSource::catalogue ? "catalogue"
                                             : "prior";
}

std::string number_text(double si, const Parameter& parameter) {
  return fmt::format("{:.6g}", si == 0 ? 0 : si / parameter.unit);
}

/// One line for each parameter.
std::string parameters_text(const Machine& machine) {
  const std::vector<Parameter> all = parameters(machine);
  std::size_t width = std::string_view("parameter").size();
  for (const Parameter& parameter : all) width = std::max(width, parameter.name.size());
  std::string text = fmt::format("{:<{}}  {:>12}  {:>12}  {:<9}  {}\n", "parameter", width, "value", "sigma",
                                 "source", "note");
  for (const Parameter& parameter : all) {
    const ParameterStatement* stated = statement_of(machine, parameter);
    std::string line = fmt::format(
        "{:<{}}  {:>12}  {:>12}  {:<9}  {}", parameter.name, width, number_text(parameter.value, parameter),
        stated != nullptr && stated->sigma ? number_text(*stated->sigma, parameter) : "-",
        stated != nullptr ? name_of(stated->source) : "-", stated != nullptr ? stated->note : "");
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

nlohmann::ordered_json parameters_json(const Machine& machine) {
  auto list = nlohmann::ordered_json::array();
  for (const Parameter& parameter : parameters(machine)) {
    nlohmann::ordered_json row{{"name", parameter.name}, {"value", parameter.value / parameter.unit}};
    if (const ParameterStatement* stated = statement_of(machine, parameter)) {
      row["sigma"] = stated->sigma ? nlohmann::ordered_json(*stated->sigma / parameter.unit)
                                   : nlohmann::ordered_json(nullptr);
      row["source"] = name_of(stated->source);
      row["note"] = stated->note;
    }
    list.push_back(std::move(row));
  }
  return list;
}

void draw(const Machine& machine, const Model& model, const std::string& path) {
  FileWriter file(path);
  file.write(machine_drawing(machine, model));
  publish_together({&file});
}

}  // namespace

Checked check_machine(const std::string& path, const Options& options, Console& console) {
  const Machine machine = read_machine(read_input(path, ErrorKind::machine_or_force), path);
  if (options.check.parameters)
    return {row("file", path) + "\n" + parameters_text(machine),
            "",
            {{"file", path}, {"kind", "machine"}, {"parameters", parameters_json(machine)}}};
  const Model model = prepare(machine);
  refuse_home(model, machine);
  if (options.check.draw) draw(machine, model, *options.check.draw);
  const HomeFacts home = look_at_home(model);
  const auto notes = notes_of(machine, model, home);

  Checked checked;
  checked.text = row("file", path) + describe(machine) + home_text(machine, model, home);
  if (!notes.empty()) checked.text += "\nnotes\n";
  for (const std::string& note : notes) checked.text += fmt::format("  {}\n", note);
  constexpr const char* components[] = {"x", "y", "z", "rx", "ry", "rz"};
  auto controlled = nlohmann::ordered_json::array();
  for (const Component c : machine.controlled) controlled.push_back(components[static_cast<int>(c)]);
  checked.json = {{"file", path},
                  {"kind", "machine"},
                  {"name", machine.name},
                  {"controlled", controlled},
                  {"chains", chains_json(machine, home)},
                  {"actuators", actuators_json(model, home)},
                  {"home", home_json(model, home)}};
  if (!machine.gravity.g.isZero(0) || total_mass(machine) > 0)
    checked.json["gravity"] = gravity_json(machine);
  if (!machine.tools.empty()) checked.json["tools"] = tools_json(machine);
  if (!machine.parameters.empty()) checked.json["numbers"] = numbers_json(machine);
  checked.json["notes"] = notes;
  add_sanity(machine_sanity(machine, model), machine, checked, console);
  return checked;
}

}  // namespace counterflex::cli
