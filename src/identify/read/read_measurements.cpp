#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/coupon.hpp"
#include "counterflex/machine/shown.hpp"
#include "identify/read/axis_motion.hpp"
#include "identify/read/description.hpp"
#include "identify/read/kinds.hpp"
#include "identify/read/push.hpp"
#include "identify/read/repeat.hpp"
#include "identify/read/table.hpp"

namespace counterflex {
namespace {

using namespace measurement_file;

constexpr double default_radius = 50 * mm;  // of a motion that shows squareness or scale

/// Whether the value of a kind is an angle or a ratio whose deviation has a column of its own.
bool is_slope(MeasurementKind kind) {
  return kind == MeasurementKind::squareness || kind == MeasurementKind::scale;
}

std::string_view sigma_column(MeasurementKind kind) {
  return kind == MeasurementKind::squareness ? "sigma_squareness"
         : kind == MeasurementKind::scale    ? "sigma_scale"
                                             : "sigma";
}

/// Makes measurements of the rows of one table.
class RowReader {
 public:
  RowReader(const std::string& file, const Machine& machine, const Description& description,
            Measurements& all)
      : file_(file),
        machine_(machine),
        description_(description),
        all_(all),
        axes_(machine),
        shown_home_(shown_homes(machine)) {}

  void read(std::string_view text) {
    Table table(text, file_, description_, machine_);
    table_ = &table;
    check_actuators();
    while (table.next()) read_row();
    if (!open_bars_.empty())
      csv::fail(open_bars_.begin()->second.at,
                fmt::format("bar \"{}\" has one end; a bar has two rows, one for each end",
                            open_bars_.begin()->first));
  }

 private:
  /// Before the first row, where all rows have one kind.
  void check_actuators() const {
    if (table_->has("kind") || (description_.kind && !needs_actuators(*description_.kind))) return;
    for (std::size_t i = 0; i < axes_.count(); ++i)
      if (!table_->has(fmt::format("q{}", i + 1)))
        table_->fail("", fmt::format("the values of {} are missing; add a column q{}_{}", axes_.name(i),
                                     i + 1, axes_.turns(i) ? "deg" : "mm"));
  }

  MeasurementKind kind_of_row() const {
    const csv::Field* field = table_->text("kind");
    if (field == nullptr) {
      if (description_.kind) return *description_.kind;
      table_->fail("", fmt::format("the kind of the rows is not known; add a column \"kind\" with one of {}",
                                   kind_names()));
    }
    const std::optional<MeasurementKind> kind = kind_named(field->text);
    if (!kind)
      table_->fail("kind", fmt::format("kind is \"{}\"; it must be one of {}", without_controls(field->text),
                                       kind_names()));
    return *kind;
  }

  std::string session_name() const {
    const csv::Field* field = table_->text("session");
    if (field != nullptr && !field->text.empty()) return without_controls(field->text);
    return description_.session.empty() ? name_of_file() : description_.session;
  }

  /// With its folder where a file that was read before has the same name.
  std::string name_of_file() const {
    const auto stem_of = [](const std::string& file) {
      return std::filesystem::path(file).stem().generic_string();
    };
    const bool is_taken = std::ranges::any_of(all_.sessions, [&](const Session& session) {
      return session.file != file_ && stem_of(session.file) == stem_of(file_);
    });
    return is_taken ? file_ : stem_of(file_);
  }

  /// `part` distinguishes rows of one session whose unknowns differ.
  std::size_t session_of(MeasurementKind kind, const std::string& part = "") {
    const std::string name = session_name() + part;
    const bool sigma_given =
        table_->is_filled(sigma_column(kind)) || (!is_slope(kind) && table_->is_filled("sigma_angle"));
    for (std::size_t i = 0; i < all_.sessions.size(); ++i) {
      Session& session = all_.sessions[i];
      if (session.name != name || session.kind != kind) continue;
      session.sigma_given = session.sigma_given || sigma_given;
      return i;
    }
    all_.sessions.push_back({name, kind, sigma_given, description_.X_TB});
    all_.sessions.back().file = file_;
    all_.sessions.back().has_known_frame = description_.has_known_frame;
    if (description_.has_known_frame) all_.sessions.back().probe_sigma = 0;
    if (description_.probe_sigma) all_.sessions.back().probe_sigma = *description_.probe_sigma;
    return all_.sessions.size() - 1;
  }

  /// The deviation of the row's value.
  void set_sigma(MeasurementKind kind, Measurement& row) const {
    row.sigma = table_->value_or(sigma_column(kind), default_sigma(kind));
    if (!(row.sigma > 0)) table_->fail(sigma_column(kind), "a standard deviation is not positive");
  }

  /// Actuator values of the row; those of home for actuators without a column where the kind allows that.
  Eigen::VectorXd shown_values_of(MeasurementKind kind) const {
    Eigen::VectorXd shown = shown_home_;
    for (std::size_t i = 0; i < axes_.count(); ++i) {
      const std::string name = fmt::format("q{}", i + 1);
      if (!table_->has(name) && needs_actuators(kind))
        table_->fail("", fmt::format("rows of kind {} need a column \"{}\"", name_of(kind), name));
      if (table_->is_filled(name) || needs_actuators(kind))
        shown[static_cast<Eigen::Index>(i)] = table_->value(name);
    }
    return shown;
  }

  Vector3 vector(std::string_view x, std::string_view y, std::string_view z) const {
    return {table_->value_or(x, 0), table_->value_or(y, 0), table_->value_or(z, 0)};
  }

  /// "+", "-", "up", "down" of all actuators, or of the axis `only`; "+-0+00", a sign for each; "previous":
  /// from the row before.
  Directions directions_of(std::size_t session, const Eigen::VectorXd& shown,
                           std::optional<std::size_t> only = {}) {
    const csv::Field* field = table_->text("direction");
    const std::string_view text = field != nullptr ? field->text : std::string_view(description_.direction);
    if (text.empty() || text == "0") return {};
    if (text == "previous") {
      const auto before = last_.find(session);
      const Directions directions =
          before == last_.end()
              ? Directions{}
              : axes_.directions_between(before->second.shown, shown, before->second.directions);
      last_[session] = {shown, Vector6::Zero(), directions};
      return directions;
    }
    const auto n = static_cast<Eigen::Index>(axes_.count());
    Eigen::VectorXd signs = Eigen::VectorXd::Zero(n);
    const bool is_up = text == "+" || text == "up";
    if (is_up || text == "-" || text == "down")
      (only ? signs.segment(static_cast<Eigen::Index>(*only), 1) : signs.segment(0, n))
          .setConstant(is_up ? 1 : -1);
    else if (text.size() == axes_.count() && text.find_first_not_of("+-0") == std::string_view::npos)
      for (Eigen::Index i = 0; i < n; ++i) {
        const char sign = text[static_cast<std::size_t>(i)];
        signs[i] = sign == '+' ? 1 : sign == '-' ? -1 : 0;
      }
    else
      table_->fail(
          "direction",
          fmt::format("direction is \"{}\"; it must be +, -, up, down, previous, or {} signs of +, - "
                      "and 0, one for each actuator",
                      without_controls(text), axes_.count()));
    return axes_.directions_of(signs);
  }

  void read_row() {
    const MeasurementKind kind = kind_of_row();
    if (kind == MeasurementKind::cmm_feature)
      table_->fail(
          "kind",
          "rows of kind cmm_feature are those of a sheet that testcut wrote; pass the sheet as it is");
    for (const std::string_view name : needed_columns(kind))
      if (!table_->has(name) && !(name == "direction" && !description_.direction.empty()))
        table_->fail("", fmt::format("rows of kind {} need a column \"{}\"", name_of(kind), name));
    if (kind == MeasurementKind::repeat) return all_.repeats.push_back(read_repeat(*table_, session_name()));
    Measurement row;
    row.at = {file_, table_->where().line, 1};
    if (is_slope(kind) && !table_->is_filled(sigma_column(kind)) && table_->is_filled("sigma"))
      table_->fail(
          "sigma",
          fmt::format("sigma is a length; give the deviation of a {} in a column {}_um_per_m, and leave "
                      "this field empty",
                      name_of(kind), sigma_column(kind)));
    row.sigma_angle = table_->value_or("sigma_angle", default_sigma_angle);
    if (!(row.sigma_angle > 0)) table_->fail("sigma_angle", "a standard deviation is not positive");
    set_sigma(kind, row);
    switch (kind) {
      case MeasurementKind::squareness:
      case MeasurementKind::ballbar:
        return read_axes(kind, row);
      case MeasurementKind::axis_table:
      case MeasurementKind::reversal:
      case MeasurementKind::scale:
      case MeasurementKind::clamped_torque:
        return read_axis(kind, row, axis_named("axis"));
      default:
        return read_tip(kind, row);
    }
  }

  /// Rows of a tip whose actuator values they state.
  void read_tip(MeasurementKind kind, Measurement& row) {
    row.session = session_of(kind);
    row.states.push_back({shown_values_of(kind)});
    row.states[0].directions = directions_of(row.session, row.states[0].shown);
    if (kind == MeasurementKind::length_bar && !read_bar(row)) return;
    read_reading(kind, row);
    all_.rows.push_back(std::move(row));
  }

  /// What was measured at the row's first state.
  void read_reading(MeasurementKind kind, Measurement& row) {
    switch (kind) {
      case MeasurementKind::tracker_pose:
        row.X.R = description_.rotation_of(vector("rx", "ry", "rz"));
        [[fallthrough]];
      case MeasurementKind::tracker_point:
        row.X.p = vector("x", "y", "z");
        break;
      case MeasurementKind::static_push:
      case MeasurementKind::hung_weight:
        read_push(*table_, axes_, machine_.gravity.of_hung, kind, all_.sessions[row.session], row);
        break;
      case MeasurementKind::axis_position:
        row.direction = gauge_direction(*table_);
        row.value = table_->value("reading");
        break;
      default:
        break;
    }
  }

  /// False: the row is the first end of a bar.
  bool read_bar(Measurement& row) {
    const csv::Field* bar = table_->text("bar");
    const std::string name = bar == nullptr ? "" : std::string(bar->text);
    row.value = table_->value("length");
    const auto open = open_bars_.find(name);
    if (open == open_bars_.end()) {
      open_bars_.emplace(name, row);
      return false;
    }
    const Measurement& first = open->second;
    if (first.value != row.value)
      table_->fail("length", fmt::format("the length of the bar is {:g} mm here and {:g} mm in line {}",
                                         row.value / mm, first.value / mm, first.at.line));
    row.states.push_back(first.states[0]);
    open_bars_.erase(open);
    return true;
  }

  double radius() const {
    const double radius = table_->value_or("radius", default_radius);
    if (!(radius > 0))
      table_->fail("radius", fmt::format("the radius is {:g} mm; it must be above 0", radius / mm));
    return radius;
  }

  std::size_t axis_named(std::string_view column) const {
    const csv::Field* field = table_->text(column);
    const std::optional<std::size_t> axis = axes_.find(field == nullptr ? "" : field->text);
    if (axis) return *axis;
    std::string known;
    for (std::size_t i = 0; i < axes_.count(); ++i)
      known += fmt::format("{}{}", i == 0 ? "" : ", ", letter_of(axes_.name(i)));
    table_->fail(column, fmt::format("{} is \"{}\"; it must be one of {}", column,
                                     field == nullptr ? "" : without_controls(field->text), known));
  }

  /// The value of a column that has the unit of an axis.
  double axis_value(std::string_view column, std::size_t axis) const {
    if (table_->is_angle(column) && !axes_.turns(axis))
      table_->fail(column, fmt::format("{} has a unit of angles; {} is linear", column, axes_.name(axis)));
    if (!table_->is_angle(column) && axes_.turns(axis))
      table_->fail(column, fmt::format("{} has a unit of lengths; {} turns", column, axes_.name(axis)));
    return table_->value(column);
  }

  /// The deviation of a row whose value has the unit of an axis.
  void set_sigma_of(std::size_t axis, Measurement& row) const {
    row.is_length = !axes_.turns(axis);
    if (!row.is_length) row.sigma = table_->value_or("sigma_angle", default_sigma_axis_angle);
  }

  /// The state with an axis moved by `by`, or as far as its travel allows.
  CommandedState moved(const Eigen::VectorXd& shown, std::size_t axis, double by) const {
    CommandedState state{shown};
    double& q = state.shown[static_cast<Eigen::Index>(axis)];
    q = by > 0 ? std::min(q + by, std::max(axes_.actuator(axis).max, q))
               : std::max(q + by, std::min(axes_.actuator(axis).min, q));
    return state;
  }

  /// Rows of a single axis.
  void read_axis(MeasurementKind kind, Measurement row, std::size_t axis) {
    row.session = session_of(kind, fmt::format(" {}", letter_of(axes_.name(axis))));
    CommandedState state{shown_values_of(kind)};
    if (kind == MeasurementKind::clamped_torque) {
      if (!axes_.turns(axis))
        table_->fail("axis", fmt::format("{} is linear; rows of kind clamped_torque need a rotary axis",
                                         axes_.name(axis)));
      set_sigma_of(axis, row);
      row.value = state.shown[static_cast<Eigen::Index>(axis)];
      state.clamped = ClampedTorque{axis, table_->value("torque")};
      row.states = {state};
      all_.rows.push_back(std::move(row));
      return;
    }
    if (kind == MeasurementKind::axis_table)
      state.shown[static_cast<Eigen::Index>(axis)] = axis_value("position", axis);
    const std::optional<Vector3> direction = axes_.direction_of(axis, state.shown);
    if (!direction)
      table_->fail("axis",
                   fmt::format("the tip does not move as far as {}; measure the tip with rows of kind "
                               "axis_position",
                               axes_.name(axis)));
    row.direction = *direction;
    const Eigen::VectorXd forward =
        Eigen::VectorXd::Unit(shown_home_.size(), static_cast<Eigen::Index>(axis));
    if (kind == MeasurementKind::axis_table) {
      set_sigma_of(axis, row);
      row.value = axis_value("deviation", axis);
      state.directions = directions_of(row.session, state.shown, axis);
      row.states = {state};
    } else if (kind == MeasurementKind::reversal) {
      set_sigma_of(axis, row);
      row.value = axis_value("reversal", axis);
      row.states = {state, state};
      row.states[0].directions = axes_.directions_of(forward);
      row.states[1].directions = axes_.directions_of(-forward);
    } else {
      if (axes_.turns(axis))
        table_->fail("axis",
                     fmt::format("{} turns; rows of kind scale need a linear axis", axes_.name(axis)));
      row.is_length = false;
      row.value = table_->value("scale");
      set_sigma(kind, row);
      row.states = {moved(state.shown, axis, -radius()), moved(state.shown, axis, radius())};
    }
    all_.rows.push_back(std::move(row));
  }

  /// Rows of two linear axes: a squareness, or the numbers of a ball bar's report.
  void read_axes(MeasurementKind kind, const Measurement& row) {
    const csv::Field* field = table_->text("axes");
    const std::string_view text = field == nullptr ? std::string_view() : field->text;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < text.size(); ++i)
      if (const auto axis = axes_.find(text.substr(i, 1)); axis && !axes_.turns(*axis))
        found.push_back(*axis);
    const bool is_pair = text.size() == 2 && found.size() == 2 && found[0] != found[1];
    const bool is_one = kind == MeasurementKind::ballbar && text.size() == 1 && found.size() == 1;
    if (!is_pair && !is_one)
      table_->fail(
          "axes", fmt::format("axes is \"{}\"; it must name two linear axes of the machine, as XY{}",
                              without_controls(text),
                              kind == MeasurementKind::ballbar ? ", or one for its reversal and scale" : ""));
    if (kind == MeasurementKind::squareness || (is_pair && table_->is_filled("squareness")))
      read_squareness(found, row);
    if (kind == MeasurementKind::squareness) return;
    for (const auto& [name, part] :
         {std::pair{"reversal", MeasurementKind::reversal}, std::pair{"scale", MeasurementKind::scale}}) {
      if (!table_->is_filled(name)) continue;
      if (is_pair)
        table_->fail("axes", fmt::format("axes is \"{}\"; the {} is that of one axis", text, name));
      Measurement one = row;
      set_sigma(part, one);
      read_axis(part, one, found[0]);
    }
    if (is_one && table_->is_filled("squareness"))
      table_->fail("axes", fmt::format("axes is \"{}\"; a squareness is that of two axes", text));
    if (!table_->is_filled("squareness") && !table_->is_filled("reversal") && !table_->is_filled("scale"))
      table_->fail("", "the row has no squareness, no reversal and no scale");
  }

  /// Four states: each axis to both sides.
  void read_squareness(const std::vector<std::size_t>& pair, Measurement row) {
    const Eigen::VectorXd centre = shown_values_of(MeasurementKind::squareness);
    for (const std::size_t axis : pair)
      for (const double side : {-1.0, 1.0}) row.states.push_back(moved(centre, axis, side * radius()));
    row.session = session_of(MeasurementKind::squareness);
    row.is_length = false;
    row.value = table_->value("squareness");
    set_sigma(MeasurementKind::squareness, row);
    all_.rows.push_back(std::move(row));
  }

  std::string file_;
  const Machine& machine_;
  const Description& description_;
  Measurements& all_;
  Table* table_ = nullptr;
  Axes axes_;
  Eigen::VectorXd shown_home_;
  std::map<std::string, Measurement> open_bars_;  ///< rows of first ends, by the bar's name
  std::map<std::size_t, CommandedState> last_;    ///< by session: the row before
};

}  // namespace

void read_measurements(std::string_view csv, const std::string& file, const Machine& machine,
                       Measurements& all) {
  if (is_coupon_sheet(csv)) return read_coupon_sheet(csv, file, machine, all);
  RowReader(file, machine, Description{}, all).read(csv);
}

void load_measurements(const std::string& file, const Machine& machine, Measurements& all) {
  const auto count = [&] { return all.rows.size() + all.repeats.size() + all.empty_rows; };
  const std::size_t before = count();
  if (file.ends_with(".toml")) {
    const Description description = read_description(read_file(file), file, machine);
    const std::string text = read_file(description.csv);
    RowReader(description.csv, machine, description, all).read(text);
  } else {
    read_measurements(read_file(file), file, machine, all);
  }
  if (count() == before)
    throw InputError(ErrorKind::machine_or_force, {file}, "the file has no rows of measurements");
}

}  // namespace counterflex
