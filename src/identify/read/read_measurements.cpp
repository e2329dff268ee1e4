#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/measurements.hpp"
#include "counterflex/machine/shown.hpp"
#include "identify/read/columns.hpp"
#include "identify/read/description.hpp"

namespace counterflex {
namespace {

using namespace measurement_file;

constexpr std::array<std::string_view, 8> kind_names = {"tracker_point", "tracker_pose",  "static_push",
                                                        "hung_weight",   "plane_contact", "length_bar",
                                                        "squareness",    "axis_position"};

// Standard deviations of rows that give none: a laser tracker, a dial gauge, a touch, a bar, a ball bar.
constexpr double default_sigma_tracker = 0.05 * mm, default_sigma_angle = 0.01 * deg,
                 default_sigma_gauge = 5 * um, default_sigma_touch = 0.02 * mm,
                 default_sigma_squareness = 5e-6;
constexpr double default_weight_g = 9.80665;  // m/s2, where the machine file has no gravity

std::optional<MeasurementKind> kind_named(std::string_view name) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), name);
  if (found == kind_names.end()) return {};
  return static_cast<MeasurementKind>(found - kind_names.begin());
}

/// The columns that rows of a kind need besides those of the actuators.
std::vector<std::string_view> needed(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::tracker_point:
      return {"x", "y", "z"};
    case MeasurementKind::tracker_pose:
      return {"x", "y", "z", "rx", "ry", "rz"};
    case MeasurementKind::static_push:
      return {"reading", "gx", "gy", "gz"};
    case MeasurementKind::hung_weight:
      return {"reading", "mass"};
    case MeasurementKind::plane_contact:
      return {};
    case MeasurementKind::length_bar:
      return {"bar", "length"};
    case MeasurementKind::squareness:
      return {"axes", "squareness"};
    case MeasurementKind::axis_position:
      return {"reading", "gx", "gy", "gz"};
  }
  return {};
}

double default_sigma(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::tracker_point:
    case MeasurementKind::tracker_pose:
      return default_sigma_tracker;
    case MeasurementKind::plane_contact:
    case MeasurementKind::length_bar:
      return default_sigma_touch;
    case MeasurementKind::squareness:
      return default_sigma_squareness;
    default:
      return default_sigma_gauge;
  }
}

/// The rows of one CSV text.
class RowReader {
 public:
  RowReader(const std::string& file, const Machine& machine, const Description& description,
            Measurements& all)
      : file_(file),
        machine_(machine),
        description_(description),
        all_(all),
        actuators_(actuators(machine)),
        names_(actuator_names(machine)),
        shown_home_(shown_homes(machine)) {}

  void read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    bool has_header = false;
    Location where{file_, 0, 1};
    while (!text.empty()) {
      const std::string_view line = csv::take_line(text);
      ++where.line;
      if (csv::trimmed(line).empty() || csv::trimmed(line).starts_with('#')) continue;
      if (!has_header) {
        read_header(line, where);
        has_header = true;
      } else {
        read_row(line, where);
      }
    }
    if (!has_header) csv::fail({file_, 0, 0}, "the file has no row with the names of its columns");
    if (!open_bars_.empty())
      csv::fail(open_bars_.begin()->second,
                fmt::format("bar \"{}\" has one end; a bar has two rows, one for each end",
                            open_bars_.begin()->first));
  }

 private:
  void read_header(std::string_view line, const Location& where) {
    separator_ = line.find(';') != std::string_view::npos    ? ';'
                 : line.find('\t') != std::string_view::npos ? '\t'
                                                             : ',';
    const std::vector<csv::Field> fields = csv::split(line, 1, separator_);
    count_ = fields.size();
    columns_ = description_.constants;
    std::set<std::string, std::less<>> seen;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Location at{file_, where.line, fields[i].column};
      if (!seen.insert(std::string(fields[i].text)).second)
        csv::fail(at, fmt::format("column \"{}\" is there twice", without_controls(fields[i].text)));
      if (description_.is_mapped) {
        for (const auto& [name, quantity] : description_.names)
          if (name == fields[i].text) columns_[quantity.name] = {i, quantity.si, {}};
        continue;
      }
      const std::optional<Quantity> quantity = quantity_of(fields[i].text, machine_);
      if (!quantity)
        csv::fail(at, fmt::format("unknown column \"{}\"; known columns: {}",
                                  without_controls(fields[i].text), column_names(machine_)));
      columns_[quantity->name] = {i, quantity->si, {}};
    }
    for (const auto& [name, quantity] : description_.names)
      if (!seen.contains(name))
        csv::fail({file_, where.line, 1},
                  fmt::format("the file has no column \"{}\", which {} names", name, description_.file));
    for (std::size_t i = 0; i < actuators_.size(); ++i) {
      const std::string name = fmt::format("q{}", i + 1);
      if (description_.kind != MeasurementKind::squareness && !columns_.contains(name) &&
          !columns_.contains("kind"))
        csv::fail({file_, where.line, 1},
                  fmt::format("the values of {} are missing; add a column q{}_{}", names_[i], i + 1,
                              actuators_[i].joint.kind == JointKind::revolute ? "deg" : "mm"));
    }
  }

  const csv::Field* text_field(std::string_view name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() || found->second.constant ? nullptr : &fields_[found->second.index];
  }

  bool has(std::string_view name) const { return columns_.find(name) != columns_.end(); }

  double value(std::string_view name, const Location& where) const {
    const Column& column = columns_.find(name)->second;
    if (column.constant) return *column.constant;
    return number_of(fields_[column.index], name, separator_ != ',', where) * column.si;
  }

  double value_or(std::string_view name, double otherwise, const Location& where) const {
    return has(name) ? value(name, where) : otherwise;
  }

  Vector3 vector(std::string_view x, std::string_view y, std::string_view z, const Location& where) const {
    return {value_or(x, 0, where), value_or(y, 0, where), value_or(z, 0, where)};
  }

  MeasurementKind kind_of_row(const Location& where) const {
    const csv::Field* field = text_field("kind");
    if (field == nullptr) {
      if (description_.kind) return *description_.kind;
      csv::fail({file_, where.line, 1},
                fmt::format("the kind of the rows is not known; add a column \"kind\" with one of {}",
                            fmt::join(kind_names, ", ")));
    }
    const std::optional<MeasurementKind> kind = kind_named(field->text);
    if (!kind)
      csv::fail({file_, where.line, field->column},
                fmt::format("kind is \"{}\"; it must be one of {}", without_controls(field->text),
                            fmt::join(kind_names, ", ")));
    return *kind;
  }

  std::size_t session_of(MeasurementKind kind, bool sigma_given) {
    const csv::Field* field = text_field("session");
    const std::string name = field != nullptr && !field->text.empty() ? without_controls(field->text)
                             : !description_.session.empty()          ? description_.session
                                                             : std::filesystem::path(file_).stem().string();
    for (std::size_t i = 0; i < all_.sessions.size(); ++i)
      if (all_.sessions[i].name == name && all_.sessions[i].kind == kind) return i;
    all_.sessions.push_back({name, kind, sigma_given, description_.X_TB});
    return all_.sessions.size() - 1;
  }

  Eigen::VectorXd shown_values_of(const Location& where) const {
    Eigen::VectorXd shown(static_cast<Eigen::Index>(actuators_.size()));
    for (std::size_t i = 0; i < actuators_.size(); ++i)
      shown[static_cast<Eigen::Index>(i)] = value(fmt::format("q{}", i + 1), where);
    return shown;
  }

  Vector3 gauge_direction(MeasurementKind kind, const Location& where) const {
    if (kind == MeasurementKind::hung_weight && !has("gx") && !has("gy") && !has("gz"))
      return -Vector3::UnitZ();
    const Vector3 direction = vector("gx", "gy", "gz", where);
    if (!(direction.norm() > 1e-6))
      csv::fail({file_, where.line, 1}, "gx, gy, gz are zero; they must be the direction of the gauge");
    return direction.normalized();
  }

  void read_row(std::string_view line, const Location& where) {
    fields_ = csv::split(line, 1, separator_);
    if (fields_.size() != count_)
      csv::fail({file_, where.line, 1},
                fmt::format("the row has {} fields; the first row names {} columns", fields_.size(), count_));
    const MeasurementKind kind = kind_of_row(where);
    for (const std::string_view name : needed(kind))
      if (!has(name))
        csv::fail({file_, where.line, 1},
                  fmt::format("rows of kind {} need a column \"{}\"", name_of(kind), name));
    Measurement row;
    row.at = {file_, where.line, 1};
    const bool sigma_given = has("sigma");
    row.sigma = sigma_given ? value("sigma", where) : default_sigma(kind);
    row.sigma_angle = value_or("sigma_angle", default_sigma_angle, where);
    if (!(row.sigma > 0 && row.sigma_angle > 0))
      csv::fail({file_, where.line, 1}, "a standard deviation is not positive");
    row.session = session_of(kind, sigma_given);
    if (kind == MeasurementKind::squareness) {
      read_squareness(where, row);
      return;
    }
    for (std::size_t i = 0; i < actuators_.size(); ++i)
      if (!has(fmt::format("q{}", i + 1)))
        csv::fail({file_, where.line, 1},
                  fmt::format("rows of kind {} need a column \"q{}\"", name_of(kind), i + 1));
    row.states.push_back({shown_values_of(where)});
    switch (kind) {
      case MeasurementKind::tracker_pose:
        row.X.R = description_.rotation_of(vector("rx", "ry", "rz", where));
        [[fallthrough]];
      case MeasurementKind::tracker_point:
        row.X.p = vector("x", "y", "z", where);
        break;
      case MeasurementKind::static_push:
      case MeasurementKind::hung_weight: {
        row.states.push_back(row.states[0]);
        Vector6& F = row.states[0].F;
        if (kind == MeasurementKind::static_push)
          F << vector("fx", "fy", "fz", where), vector("mx", "my", "mz", where);
        else
          F.head<3>() = value("mass", where) * weight();
        if (F.isZero(0)) csv::fail({file_, where.line, 1}, "the force is zero");
        row.direction = gauge_direction(kind, where);
        row.value = value("reading", where);
        break;
      }
      case MeasurementKind::axis_position:
        row.direction = gauge_direction(kind, where);
        row.value = value("reading", where);
        break;
      case MeasurementKind::length_bar: {
        const csv::Field* bar = text_field("bar");
        const std::string name = bar == nullptr ? "" : std::string(bar->text);
        row.value = value("length", where);
        if (const auto open = open_bars_.find(name); open == open_bars_.end()) {
          open_bars_.emplace(name, row.at);
          first_ends_.emplace(name, row.states[0]);
          return;
        }
        row.states.push_back(first_ends_.at(name));
        open_bars_.erase(name);
        first_ends_.erase(name);
        break;
      }
      default:
        break;
    }
    all_.rows.push_back(std::move(row));
  }

  Vector3 weight() const {
    return machine_.gravity.g.isZero(0) ? Vector3(0, 0, -default_weight_g) : machine_.gravity.g;
  }

  /// Four states: each axis 50 mm to both sides of home, or as far as its travel allows.
  void read_squareness(const Location& where, Measurement& row) {
    const csv::Field* axes = text_field("axes");
    std::vector<std::size_t> found;
    for (const char letter : axes == nullptr ? std::string_view() : axes->text)
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (actuators_[i].joint.kind == JointKind::prismatic && names_[i] == fmt::format("axis {}", letter))
          found.push_back(i);
    if (found.size() != 2 || found[0] == found[1])
      csv::fail({file_, where.line, axes == nullptr ? 1 : axes->column},
                fmt::format("axes is \"{}\"; it must name two linear axes of the machine, as XY",
                            axes == nullptr ? "" : without_controls(axes->text)));
    for (const std::size_t axis : found)
      for (const double side : {-1.0, 1.0}) {
        CommandedState state{shown_home_};
        double& q = state.shown[static_cast<Eigen::Index>(axis)];
        q = std::clamp(q + side * 50 * mm, std::max(actuators_[axis].min, q - 50 * mm),
                       std::min(actuators_[axis].max, q + 50 * mm));
        row.states.push_back(std::move(state));
      }
    row.value = value("squareness", where);
    all_.rows.push_back(std::move(row));
  }

  std::string file_;
  const Machine& machine_;
  const Description& description_;
  Measurements& all_;
  std::vector<Actuator> actuators_;
  std::vector<std::string> names_;
  Eigen::VectorXd shown_home_;
  char separator_ = ',';
  std::size_t count_ = 0;
  Columns columns_;
  std::vector<csv::Field> fields_;
  std::map<std::string, Location> open_bars_;
  std::map<std::string, CommandedState> first_ends_;
};

}  // namespace

std::string_view name_of(MeasurementKind kind) {
  return kind_names[static_cast<std::size_t>(kind)];
}

void read_measurements(std::string_view csv, const std::string& file, const Machine& machine,
                       Measurements& all) {
  RowReader(file, machine, Description{}, all).read(csv);
}

void load_measurements(const std::string& file, const Machine& machine, Measurements& all) {
  if (!file.ends_with(".toml")) {
    read_measurements(read_file(file), file, machine, all);
    return;
  }
  const Description description = read_description(read_file(file), file, machine);
  RowReader(description.csv, machine, description, all).read(read_file(description.csv));
}

}  // namespace counterflex
