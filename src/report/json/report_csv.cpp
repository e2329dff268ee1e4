#include <array>

#include "counterflex/compensation/options.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/report/formats.hpp"
#include "report/json/fixed_digits.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {

namespace {

constexpr int length_digits = 7, angle_digits = 7, path_digits = 6, wrench_digits = 6;
constexpr std::array deviation_names = {"dx_mm", "dy_mm", "dz_mm", "drx_deg", "dry_deg", "drz_deg"};

/// Columns are not moved: the fixture's are behind all others, and only in files of machines that have one.
bool is_in_all_files(const Cause& cause) {
  return cause.curve != Quantity::fixture_x;
}

void add_names(std::string& row, std::string_view deviation) {
  for (const char* name : deviation_names) row.append(",").append(deviation).append("_").append(name);
}

template <int rows>
void add(std::string& row, const Eigen::Matrix<double, rows, 1>& values, int digits) {
  append_cells(row, {values.data(), rows}, digits);
}

void add_length(std::string& row, double value, int digits) {
  add<1>(row, Eigen::Matrix<double, 1, 1>(value / mm), digits);
}

void add_rotation(std::string& row, const Vector3& rotation) {
  add<3>(row, rotation / deg, angle_digits);
}

void add_deviation(std::string& row, const Vector6& d, bool known) {
  if (!known) {
    row.append(6, ',');
    return;
  }
  add<3>(row, d.head<3>() / mm, length_digits);
  add_rotation(row, d.tail<3>());
}

void add_bands(std::string& row, const Waypoint& w, bool corrected) {
  const bool known = w.status == Status::converged && w.covariance;
  const auto add_band = [&](const Vector6& deviation, bool has) {
    if (has)
      add_length(row, band(deviation.head<3>(), w.covariance->topLeftCorner<3, 3>()), length_digits);
    else
      row += ',';
  };
  add_band(w.before, known);
  add_band(w.after, known && corrected);
}

// An unsolved waypoint has no deviations; zeros would look like perfection.
void add_row(std::string& text, std::size_t index, const Waypoint& w, const CsvColumns& columns) {
  const bool solved = w.status == Status::converged;
  const bool attributed = solved && columns.attribution && w.causes;
  static const Causes none;
  const Causes& causes = attributed ? *w.causes : none;
  text += std::to_string(index) + ',' + std::to_string(w.line) + (w.cutting ? ",1" : ",0");
  add_length(text, w.s, path_digits);
  add<3>(text, w.p_MT / mm, path_digits);
  add<6>(text, w.wrench, wrench_digits);
  add_deviation(text, w.before, solved);
  for (const Cause& cause : all_causes)
    if (is_in_all_files(cause)) add_deviation(text, cause.of(causes), attributed);
  add_deviation(text, causes.superposition, attributed);
  add_deviation(text, w.after, solved && columns.corrected);
  add_deviation(text, causes.air, attributed && columns.corrected);
  add_deviation(text, w.correction, columns.corrected);
  text.append(",").append(to_string(w.status)).append(",").append(std::to_string(w.iterations));
  if (w.R_MT)
    add_rotation(text, rotation_between(*w.R_MT, Matrix3::Identity()));
  else
    text.append(3, ',');
  if (columns.bands) add_bands(text, w, columns.corrected);
  for (const Cause& cause : all_causes)
    if (columns.fixture && !is_in_all_files(cause)) add_deviation(text, cause.of(causes), attributed);
  text += '\n';
}

}  // namespace

std::string csv_header(const CsvColumns& columns) {
  std::string row = "index,line,cutting,s_mm,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm";
  add_names(row, "before");
  for (const Cause& cause : all_causes)
    if (is_in_all_files(cause)) add_names(row, cause.name);
  for (const char* deviation : {"superposition", "after", "air"}) add_names(row, deviation);
  for (const char* name : {"x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg"})
    row.append(",correction_").append(name);
  row += ",status,iterations,rx_deg,ry_deg,rz_deg";
  if (columns.bands) row += ",before_band_mm,after_band_mm";
  for (const Cause& cause : all_causes)
    if (columns.fixture && !is_in_all_files(cause)) add_names(row, cause.name);
  return row + "\n";
}

std::string csv_rows(std::span<const Waypoint> waypoints, const CsvColumns& columns,
                     std::size_t& next_index) {
  std::string text;
  for (const Waypoint& w : waypoints)
    if (!w.between) add_row(text, next_index++, w, columns);
  return text;
}

}  // namespace counterflex
