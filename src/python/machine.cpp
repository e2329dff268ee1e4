/// Machines on arrays. The Python files of the package check shapes and numbers before they call it.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "counterflex/compensation/solved_poses.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/parallel.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/loaded_tips.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "loaded_machine.hpp"
#include "process/read_input.hpp"
#include "process/version.hpp"

namespace counterflex::python {
namespace py = pybind11;
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Arrays. Poses are (n, 4, 4), wrenches and deviations (n, 6).

Pose pose_from(const double* T) {
  Pose X;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) X.R(i, j) = T[4 * i + j];
    X.p[i] = T[4 * i + 3];
  }
  return X;
}

void put_pose(const Pose& X, double* T) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) T[4 * i + j] = X.R(i, j);
    T[4 * i + 3] = X.p[i];
    T[12 + i] = 0;
  }
  T[15] = 1;
}

Array filled(const std::vector<py::ssize_t>& shape) {
  Array array(shape);
  std::fill_n(array.mutable_data(), array.size(), nan);
  return array;
}

std::vector<PoseRequest> requests_of(const Array& poses, const Array& wrenches) {
  std::vector<PoseRequest> requests(static_cast<std::size_t>(poses.shape(0)));
  for (std::size_t i = 0; i < requests.size(); ++i)
    requests[i] = {pose_from(poses.data() + 16 * i), Vector6(wrenches.data() + 6 * i)};
  return requests;
}

using Statuses = py::array_t<std::uint8_t>;

Eigen::VectorXd shown_of(const LoadedMachine& machine, const Eigen::VectorXd& rho) {
  return shown_values(machine.input.model.mechanism.shown, rho);
}

py::ssize_t actuators_of(const LoadedMachine& machine) {
  return static_cast<py::ssize_t>(machine.input.model.mechanism.travel.size());
}

py::tuple solve(const LoadedMachine& machine, const Array& poses, const Array& wrenches, int threads) {
  const std::vector<PoseRequest> requests = requests_of(poses, wrenches);
  std::vector<SolvedCommand> solved;
  {
    const py::gil_scoped_release released;
    solved = solve_commands(machine.input.model, machine.starts, requests, threads);
  }
  const auto n = poses.shape(0), k = actuators_of(machine);
  Statuses statuses(n);
  Array deviations = filled({n, 6}), tips = filled({n, 4, 4}), actuators = filled({n, k});
  for (py::ssize_t i = 0; i < n; ++i) {
    const SolvedCommand& at = solved[static_cast<std::size_t>(i)];
    statuses.mutable_data()[i] = static_cast<std::uint8_t>(at.status);
    if (at.status != Status::converged) continue;
    Vector6::Map(deviations.mutable_data() + 6 * i) = deviation(at.X_MT, at.wanted);
    put_pose(at.X_MT, tips.mutable_data() + 16 * i);
    Eigen::VectorXd::Map(actuators.mutable_data() + k * i, k) = shown_of(machine, at.rho);
  }
  return py::make_tuple(statuses, deviations, tips, actuators);
}

py::tuple targets(const LoadedMachine& machine, const Array& poses, const Array& wrenches, int threads) {
  const std::vector<PoseRequest> requests = requests_of(poses, wrenches);
  std::vector<SolvedTarget> solved;
  {
    const py::gil_scoped_release released;
    solved = solve_targets(machine.input.model, machine.starts, requests, threads);
  }
  const auto n = poses.shape(0), k = actuators_of(machine);
  Statuses statuses(n);
  Array commands = filled({n, 4, 4}), actuators = filled({n, k});
  for (py::ssize_t i = 0; i < n; ++i) {
    const SolvedTarget& at = solved[static_cast<std::size_t>(i)];
    statuses.mutable_data()[i] = static_cast<std::uint8_t>(at.status);
    if (at.status != Status::converged) continue;
    put_pose(at.X_MT, commands.mutable_data() + 16 * i);
    Eigen::VectorXd::Map(actuators.mutable_data() + k * i, k) = shown_of(machine, at.rho);
  }
  return py::make_tuple(statuses, commands, actuators);
}

/// Compliances at the tip (n, 6, 6), or their inverses.
py::tuple tip_matrices(const LoadedMachine& machine, const Array& poses, const Array& wrenches, bool inverse,
                       int threads) {
  constexpr std::size_t at_once = 64;  // poses of one call of the kernel; of no effect on results
  const Model& model = machine.input.model;
  const auto count = static_cast<std::size_t>(poses.shape(0));
  Statuses statuses(poses.shape(0));
  Array matrices = filled({poses.shape(0), 6, 6});
  const double *from = poses.data(), *loads = wrenches.data();
  std::uint8_t* status = statuses.mutable_data();
  double* to = matrices.mutable_data();
  const py::gil_scoped_release released;
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  const StartTable& table = machine.starts.of(model, false);
  for_each_index((count + at_once - 1) / at_once, threads, [&](std::size_t slice) {
    const std::size_t first = slice * at_once, some = std::min(at_once, count - first);
    std::vector<BatchRequest> commanded;
    for (std::size_t i = first; i < first + some; ++i) {
      const Pose X_MT = pose_from(from + 16 * i);
      commanded.push_back({{X_MT.p, rotation_between(X_MT.R, R_home)}, Vector6(loads + 6 * i)});
    }
    const std::vector<LoadedCompliance> found = loaded_compliances(table, commanded);
    for (std::size_t i = 0; i < some; ++i) {
      status[first + i] = static_cast<std::uint8_t>(found[i].status);
      if (found[i].status != Status::converged) continue;
      const auto matrix =
          inverse ? inverse_compliance(found[i].C, model.mechanism.length) : std::optional(found[i].C);
      if (matrix) RowMajor6::Map(to + 36 * (first + i)) = *matrix;
    }
  });
  const py::gil_scoped_acquire acquired;
  return py::make_tuple(statuses, matrices);
}

// Machines.

std::unique_ptr<LoadedMachine> load_file(const std::string& path) {
  const py::gil_scoped_release released;
  return load_text(cli::read_input(path, ErrorKind::machine_or_force), path);
}

/// Values by name, in the units of the names.
std::map<std::string, double> values_of(const LoadedMachine& machine) {
  std::map<std::string, double> values;
  for (const Parameter& parameter : parameters(machine.input.machine))
    values[parameter.name] = parameter.value / parameter.unit;
  return values;
}

[[noreturn]] void refuse_value(const std::string& name, double value, const std::string& allowed) {
  throw py::value_error(fmt::format("parameter {} is {}, must be {}", name, value, allowed));
}

std::unique_ptr<LoadedMachine> changed(const LoadedMachine& machine,
                                       const std::map<std::string, double>& changes) {
  const std::vector<Parameter> all = parameters(machine.input.machine);
  std::vector<double> values;
  std::string words;
  for (const Parameter& parameter : all) {
    values.push_back(parameter.value);
    const auto change = changes.find(parameter.name);
    if (change == changes.end()) continue;
    const bool scales = parameter.kind == ParameterKind::compliance || parameter.kind == ParameterKind::mass;
    if (scales && !(change->second > 0)) refuse_value(parameter.name, change->second, "above 0");
    if (parameter.kind == ParameterKind::reversal && !(change->second >= 0))
      refuse_value(parameter.name, change->second, "0 or more");
    values.back() = change->second * parameter.unit;
    words += fmt::format("\n{}={}", parameter.name, change->second);
  }
  const py::gil_scoped_release released;
  InputFile file = machine.input.file;
  file.sha256 = sha256(file.sha256 + words);
  return load(with_parameters(machine.input.machine, values), std::move(file), "");
}

std::vector<std::string> controlled_of(const LoadedMachine& machine) {
  constexpr std::array names{"x", "y", "z", "rx", "ry", "rz"};
  std::vector<std::string> controlled;
  for (const Component c : machine.input.machine.controlled)
    controlled.emplace_back(names[static_cast<std::size_t>(c)]);
  return controlled;
}

Array home_of(const LoadedMachine& machine) {
  Array home({4, 4});
  put_pose(tip(machine.input.model.mechanism, machine.input.model.home), home.mutable_data());
  return home;
}

void throw_as_python(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    const Location& where = error.where();
    const py::object type = py::module_::import("counterflex._errors").attr("InputError");
    const py::object value = type(to_str(error.what()), to_str(where.file), where.line, where.column);
    PyErr_SetObject(type.ptr(), value.ptr());
  }
}

}  // namespace

py::str to_str(std::string_view bytes) {
  PyObject* text =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "surrogateescape");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

std::unique_ptr<LoadedMachine> load(Machine machine, InputFile file, std::string text) {
  Model model = prepare(machine);
  cli::refuse_home(model, machine);
  return std::make_unique<LoadedMachine>(
      LoadedMachine{{std::move(file), std::move(machine), std::move(model)}, std::move(text)});
}

std::unique_ptr<LoadedMachine> load_text(std::string text, const std::string& path) {
  Machine machine = read_machine(text, path);
  InputFile file{"machine", path, sha256(text)};
  return load(std::move(machine), std::move(file), std::move(text));
}

PYBIND11_MODULE(_core, module) {
  py::register_exception_translator(throw_as_python);
  module.attr("version") = cli::version;
  std::vector<std::string> statuses;
  for (int s = 0; s <= static_cast<int>(Status::outside_travel); ++s)
    statuses.emplace_back(to_string(static_cast<Status>(s)));
  module.attr("statuses") = py::cast(statuses);
  py::class_<LoadedMachine>(module, "Machine")
      .def_property_readonly("name", [](const LoadedMachine& m) { return to_str(m.input.machine.name); })
      .def_property_readonly("path", [](const LoadedMachine& m) { return to_str(m.input.file.path); })
      .def_property_readonly("controlled", controlled_of)
      .def_property_readonly("actuators",
                             [](const LoadedMachine& m) { return actuator_names(m.input.machine); })
      .def_property_readonly("home", home_of)
      .def_property_readonly("parameters", values_of)
      .def("with_parameters", changed)
      .def("solve", solve)
      .def("targets", targets)
      .def("tip_matrices", tip_matrices);
  module.def("load", load_file);
  module.def("load_text", [](std::string text, const std::string& path) {
    const py::gil_scoped_release released;
    return load_text(std::move(text), path);
  });
  define_runs(module);
}

}  // namespace counterflex::python
