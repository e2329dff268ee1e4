#include "counterflex/settings/jobs_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "settings/read_settings.hpp"

namespace counterflex {
namespace {

using toml_file::Source;

std::vector<std::string> read_programs(const toml::node& node, const std::string& folder,
                                       const Source& source) {
  const auto one = [&](const toml::node& entry) {
    const std::string path = toml_file::as_text(entry, "program", source);
    if (path == "-") source.fail(entry, "program is \"-\", standard input; it must be a file");
    return setting_file::joined_path(folder, path);
  };
  if (node.is_string()) return {one(node)};
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty())
    source.fail(node, fmt::format("program must be a path, a glob or an array of these, not {}",
                                  toml_file::seen(node)));
  std::vector<std::string> programs;
  for (const toml::node& entry : *array) programs.push_back(one(entry));
  return programs;
}

/// A text without a pattern is a folder, which may not exist yet. Standard output is not allowed.
void take_as_folder(std::vector<Setting>& settings, const toml::table& table, const Source& source) {
  for (Setting& setting : settings) {
    if (setting.option != "output") continue;
    std::string& text = setting.values.at(0);
    if (text == "-")
      source.fail(*table.get("output"), "output is \"-\", standard output; it must be a folder or a pattern");
    if (!is_pattern(text) && !text.ends_with('/')) text += '/';
  }
}

/// A name without a folder is in the folder of the batch.
void put_in_folder(std::vector<Setting>& settings, const std::string& folder_of_batch) {
  for (Setting& setting : settings)
    if (setting.option == "output" && setting.values.at(0).find('/') == std::string::npos)
      setting.values[0] = as_pattern(folder_of_batch) + '/' + setting.values[0];
}

JobEntry read_job(const toml::node& node, const std::string& folder, const std::string& folder_of_batch,
                  const Source& source) {
  const toml::table& table = toml_file::as_table(node, "a job", source);
  JobEntry job;
  job.where = source.at(node.source());
  job.settings = setting_file::read_settings(table, "a job", folder, {"program"}, source);
  job.programs = read_programs(toml_file::required(table, "program", "a job", node, source), folder, source);
  take_as_folder(job.settings, table, source);
  put_in_folder(job.settings, folder_of_batch);
  return job;
}

/// The folder of the batch: the part of the common `output` before the name.
std::string folder_of_batch(const JobsFile& jobs, const toml::table& document, const Source& source) {
  const auto found = std::find_if(jobs.defaults.begin(), jobs.defaults.end(),
                                  [](const Setting& setting) { return setting.option == "output"; });
  if (found == jobs.defaults.end())
    source.fail_at_start("no output; give the folder for results and state of the batch");
  const std::string& text = found->values.at(0);
  const std::size_t slash = text.find_last_of('/');
  const std::string folder =
      slash == std::string::npos ? "" : text.substr(0, std::max<std::size_t>(slash, 1));
  if (folder.empty() || is_pattern(folder))
    source.fail(*document.get("output"),
                fmt::format("output is \"{}\"; the output of all jobs must begin with a folder",
                            document.get("output")->as_string()->get()));
  return fill(folder, {});
}

}  // namespace

JobsFile read_jobs(std::string_view text, const std::string& file) {
  const Source source(text, file);
  const toml::table document = source.parse();
  setting_file::check_format_of(document, "counterflex-jobs 1", "a jobs file", source);
  const std::string folder = setting_file::folder_of(file);
  JobsFile jobs;
  jobs.defaults = setting_file::read_settings(document, "a jobs file", folder, {"format", "job"}, source);
  take_as_folder(jobs.defaults, document, source);
  jobs.output = folder_of_batch(jobs, document, source);
  const toml::node* list = document.get("job");
  if (list == nullptr) source.fail_at_start("no job; a jobs file must have at least one [[job]]");
  if (!list->is_array() || list->as_array()->empty())
    source.fail(*list,
                fmt::format("job must be written [[job]], once or more, not {}", toml_file::seen(*list)));
  for (const toml::node& node : *list->as_array())
    jobs.jobs.push_back(read_job(node, folder, jobs.output, source));
  return jobs;
}

}  // namespace counterflex
