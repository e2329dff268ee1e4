#include "run/uncertainty.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/report/identification.hpp"
#include "process/console.hpp"
#include "process/read_input.hpp"
#include "settings/setting_options.hpp"

namespace counterflex::cli {

std::vector<InputFile> read_uncertainty_files(const Options& options, Machine& machine) {
  if (!has_setting(options.command, "uncertainty")) machine.uncertainty.reset();
  std::vector<InputFile> files;
  const auto read = [&](const char* role, const std::string& path) {
    std::string text = read_input(path, ErrorKind::machine_or_force);
    files.push_back({role, path, sha256(text)});
    return text;
  };
  if (options.uncertainty)
    machine.uncertainty = read_uncertainty(read("uncertainty", *options.uncertainty),
                                           shown_name(*options.uncertainty), machine);
  if (!machine.uncertainty) return files;
  Uncertainty& uncertainty = *machine.uncertainty;
  if (uncertainty.temperature > 0 && !options.temperature)
    throw InputError(ErrorKind::machine_or_force, uncertainty.temperature_at,
                     "temperature_K needs the temperature of the run: give --temperature-C, or leave "
                     "temperature_K out");
  if (uncertainty.covariance.empty()) return files;
  const std::string& from = options.uncertainty ? *options.uncertainty : options.machine;
  const std::string path =
      (std::filesystem::path(from).parent_path() / uncertainty.covariance).generic_string();
  std::error_code none;
  if (!std::filesystem::exists(path, none))
    throw InputError(
        ErrorKind::machine_or_force, uncertainty.covariance_at,
        fmt::format("covariance is \"{}\", but there is no such file in the folder of this file; "
                    "give the path of the STEM.json of identify --report",
                    without_controls(uncertainty.covariance)));
  uncertainty.known = read_covariance(read("covariance", path), shown_name(path), machine);
  return files;
}

}  // namespace counterflex::cli
