#pragma once
/// The lines above the rows of a force profile: settings (`# key = value`) and the names of the columns.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex::csv {

/// The settings read so far.
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

/// Throws if a required setting is missing; `where` is the header row.
void require_settings(const Settings& settings, const Location& where);

/// The content of a column: the key or one axis of it, or a component of the wrench.
struct Column {
  std::string name;
  std::optional<int> component;  ///< 0 to 5
  std::optional<int> axis;       ///< 0 to 2; without component and axis: the key
};

/// Keys of rows. All except the last two are places.
enum class RowKey { line, block_number, path_length, time, point, tool, operation };

struct Header {
  RowKey key = RowKey::line;
  std::vector<Column> columns;
};

/// Reads the header row. Throws on an unknown, repeated or missing column.
Header read_header(std::string_view line, const Location& where);

/// Throws if a setting has no meaning for the key; `where` is the header row.
void refuse_settings(const Settings& settings, RowKey key, const Location& where);

/// The name of the key's column, or columns, with its unit: "line", "n", "s_mm", "t_s", "x_mm, y_mm, z_mm".
std::string key_name(ForceKey key);

/// The factor from a key's SI value to the unit of its column.
double shown_per_si(ForceKey key);

}  // namespace counterflex::csv
