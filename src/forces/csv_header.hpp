#pragma once
/// What stands above the rows of a force profile: settings (`# key = value`) and the names of the columns.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex::csv {

/// The settings as far as they have been read.
struct Settings {
  std::optional<ForceFrame> frame;
  std::optional<bool> on_workpiece;
  std::optional<bool> linear;
  std::optional<bool> at_platform;
  std::optional<double> within;  ///< m
  std::optional<bool> machine_coordinates;
};

/// Whether a line that begins with `#` is `# key = value`; all others are comments.
bool is_setting(std::string_view line);

/// Reads one `# key = value` into `settings`; `where` is the place of the line's first byte. Throws on an
/// unknown or repeated key and on a value that is not allowed.
void read_setting(std::string_view line, const Location& where, Settings& settings);

/// Throws where a required setting has not been given; `where` is the header row.
void require_settings(const Settings& settings, const Location& where);

/// What a column holds: the key or one axis of it, or a component of the wrench.
struct Column {
  std::string name;
  std::optional<int> component;  ///< 0 to 5
  std::optional<int> axis;       ///< 0 to 2; neither: the key
};

/// What rows are named by. All but the last two are places.
enum class RowKey { line, block_number, path_length, time, point, tool, operation };

struct Header {
  RowKey key = RowKey::line;
  std::vector<Column> columns;
};

/// Reads the header row. Throws on an unknown, repeated or missing column.
Header read_header(std::string_view line, const Location& where);

/// Throws where a setting has no meaning for the key; `where` is the header row.
void refuse_settings(const Settings& settings, RowKey key, const Location& where);

/// The name of the key's column, or columns, with its unit: "line", "n", "s_mm", "t_s", "x_mm, y_mm, z_mm".
std::string key_name(ForceKey key);

/// What a key's SI value is multiplied with to be shown in the unit of its column.
double shown_per_si(ForceKey key);

}  // namespace counterflex::csv
