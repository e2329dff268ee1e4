#include "run/output_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/page.hpp"
#include "counterflex/report/report.hpp"
#include "run/header/corrected_header.hpp"
#include "run/inputs.hpp"
#include "run/proof.hpp"
#include "settings/output_names.hpp"

namespace counterflex::cli {

std::vector<std::string> inputs_of(const Options& options) {
  std::vector<std::string> inputs = files_of_program(options.program, options.data_lists);
  inputs.push_back(options.machine);
  if (!options.verify.corrected.empty()) inputs.push_back(options.verify.corrected);
  inputs.insert(inputs.end(), options.forces.begin(), options.forces.end());
  if (options.tool_table) inputs.push_back(*options.tool_table);
  if (options.uncertainty) inputs.push_back(*options.uncertainty);
  if (!options.project_file.empty()) inputs.push_back(options.project_file);
  return inputs;
}

namespace {

namespace fs = std::filesystem;

void check_place(const std::string& path, const std::vector<std::string>& made = {}) {
  if (path == "-") return;
  std::error_code ignored;
  if (path.empty() || fs::is_directory(path, ignored))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("cannot write to '{}': it is not the name of a file", path));
  const fs::path folder = fs::path(path).parent_path();
  const bool is_made = std::find(made.begin(), made.end(), folder.generic_string()) != made.end();
  if (is_made && fs::exists(folder, ignored) && !fs::is_directory(folder, ignored))
    throw InputError(ErrorKind::usage, {path},
                     fmt::format("cannot write the file: '{}' is a file, not a folder; give another folder",
                                 folder.generic_string()));
  if (!folder.empty() && !is_made && !fs::is_directory(folder, ignored))
    throw InputError(ErrorKind::usage, {path}, "cannot write the file: its folder does not exist; create it");
}

/// Refuses control characters in names of outputs: a foreign project file must not control the terminal.
/// Names of programs are not changed.
void refuse_control_characters(const std::vector<std::string>& outputs, const std::string& program) {
  if (without_controls(program) != program) return;
  for (const std::string& path : outputs)
    if (without_controls(path) != path)
      throw InputError(ErrorKind::usage, {},
                       fmt::format("the name of the output '{}' has control characters; give another name",
                                   without_controls(path)));
}

[[noreturn]] void refuse_replacing(const std::string& output, const std::string& input) {
  throw InputError(ErrorKind::usage, {output},
                   fmt::format("the output would replace the input {}; give another name", input));
}

/// Whether `mark` is in the first bytes of a file.
bool begins_with_mark(const std::string& path, std::string_view mark) {
  constexpr std::size_t looked_at = 1 << 14;
  std::string bytes;
  FileReader(path).append(bytes, looked_at);
  return bytes.find(mark) != std::string::npos;
}

}  // namespace

void check_paths(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& made) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    check_place(outputs[i], made);
    for (const std::string& input : inputs)
      if (is_same_file(outputs[i], input)) refuse_replacing(outputs[i], input);
    for (std::size_t k = 0; k < i; ++k)
      if (is_same_file(outputs[i], outputs[k]))
        throw InputError(ErrorKind::usage, {outputs[i]},
                         "two outputs have this name; give one of them another name");
  }
}

void refuse_part_of_other(const std::string& file, const std::string& program) {
  const std::string divided = divided_program_of(file);
  if (divided.empty() || is_same_file(divided, program)) return;
  throw InputError(ErrorKind::usage, {file},
                   fmt::format("the file is a part of the divided program {}, which calls it; write into "
                               "another folder, or remove both files",
                               without_controls(divided)));
}

void refuse_no_svg(std::string_view option, const std::string& path) {
  if (fs::path(path).extension() != ".svg")
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{} writes a file that ends in .svg, not '{}'", option, path));
}

std::string stem_of_report(const Options& options) {
  if (options.report->empty() || *options.report == "-")
    throw InputError(ErrorKind::usage, {}, "--report needs the stem of file names, not standard output (-)");
  const fs::path name = fs::path(*options.report).filename();
  if (name == "." || name == "..")
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--report needs the stem of file names; '{}' is a folder", *options.report));
  return *options.report;
}

std::string corrected_list(const std::string& list, const std::string& program,
                           const std::string& corrected) {
  const fs::path path(list), output(corrected);
  if (is_same_file(list, data_list_beside(program)))
    return fs::path(output).replace_extension(path.extension()).generic_string();
  const fs::path same_name = output.parent_path() / path.filename();
  return is_same_file(same_name.generic_string(), list) ? default_output(list) : same_name.generic_string();
}

bool belongs_to_control(const std::string& list) {
  return fs::path(list).filename().generic_string().starts_with('$');
}

std::vector<std::string> part_paths(const OutputPaths& paths, const std::vector<ProgramPart>& parts,
                                    const Options& options) {
  if (paths.program == "-")
    throw InputError(
        ErrorKind::usage, {},
        "the program is divided into parts, and only one file can go to standard output; give -o a "
        "file");
  const fs::path main(paths.program);
  std::vector<std::string> files{paths.program};
  for (std::size_t i = 1; i < parts.size(); ++i)
    files.push_back((main.parent_path() / parts[i].name).generic_string() +
                    main.extension().generic_string());
  check_paths(files, inputs_of(options), options.folders);
  files.erase(files.begin());
  // Modules of two programs may have one name. What the last run wrote is replaced.
  for (const std::string& file : files) {
    if (paths.job_files != nullptr) paths.job_files->refuse_others(file, paths.program);
    if (are_of_one_program(file, paths.program)) continue;
    refuse_part_of_other(file, paths.program);
    if (!options.force_overwrite && fs::exists(file) && fs::file_size(file) > 0)
      throw InputError(
          ErrorKind::usage, {file},
          fmt::format("the program is divided, and the file of this part exists and is not one of those "
                      "of {} as it was; write into another folder, or give --force-overwrite",
                      without_controls(paths.program)));
  }
  return files;
}

namespace {

std::vector<OutputPaths::List> lists_of(const Options& options, const std::string& corrected) {
  std::vector<OutputPaths::List> lists;
  const std::vector<std::string> files = files_of_program(options.program, options.data_lists);
  if (corrected == "-" && files.size() > 1)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("the program has the data list {}, and only one file can go to standard output; give -o "
                    "a file",
                    shown_name(files[1])));
  for (std::size_t i = 1; i < files.size(); ++i)
    lists.push_back({corrected_list(files[i], options.program, corrected), files[i],
                     is_same_file(files[i], data_list_beside(options.program))});
  return lists;
}

}  // namespace

OutputPaths output_paths(const Options& options) {
  OutputPaths paths;
  std::vector<std::string> outputs;
  if (options.command == Command::compensate) {
    paths.program = options.output.value_or(default_output(options.program));
    outputs.push_back(paths.program);
    paths.lists = lists_of(options, paths.program);
    for (const OutputPaths::List& list : paths.lists) outputs.push_back(list.path);
  }
  if (options.report) {
    paths.report_json = stem_of_report(options) + ".json";
    paths.report_csv = stem_of_report(options) + ".csv";
    paths.report_page = stem_of_report(options) + ".html";
    outputs.insert(outputs.end(), {paths.report_json, paths.report_csv, paths.report_page});
  }
  if (options.plot) {
    refuse_no_svg("--plot", *options.plot);
    outputs.push_back(paths.plot = *options.plot);
  }
  if (paths.program == "-" && options.json)
    throw InputError(
        ErrorKind::usage, {},
        "the program and the document of --json cannot both go to standard output; give -o a file");
  if (wants_proof(options) && !options.report)
    throw InputError(ErrorKind::usage, {},
                     "--proof adds a setup sheet to the page of the report, and no report is written; add "
                     "--report STEM, or leave out --proof");
  refuse_control_characters(outputs, options.program);
  check_paths(outputs, inputs_of(options), options.folders);
  paths.folders = options.folders;
  paths.job_files = options.job_files;
  paths.force_overwrite = options.force_overwrite;
  return paths;
}

void refuse_replaced(const OutputPaths& paths, const std::vector<InputFile>& inputs) {
  for (const std::string& output :
       {paths.program, paths.report_json, paths.report_csv, paths.report_page, paths.plot})
    for (const InputFile& input : inputs)
      if (!output.empty() && is_same_file(output, input.path)) refuse_replacing(output, input.path);
}

void refuse_foreign(const std::vector<OwnFile>& files) {
  for (const OwnFile& file : files) {
    std::error_code error;
    if (file.path.empty() || file.path == "-" || !fs::is_regular_file(file.path, error)) continue;
    if (fs::file_size(file.path, error) == 0 || file.is_own(file.path)) continue;
    throw InputError(
        ErrorKind::usage, {file.path},
        "the file exists, and counterflex did not write it; give another name, or --force-overwrite "
        "to replace it");
  }
}

OwnFile marked_file(const std::string& path, std::string_view mark) {
  return {path, [mark](const std::string& own) { return begins_with_mark(own, mark); }};
}

OwnFile page_file(const std::string& path) {
  return marked_file(path, "content=\"counterflex\"");
}

OwnFile list_file(const OutputPaths::List& list, const std::string& corrected) {
  return {list.path, [corrected](const std::string&) { return has_corrected_header(corrected); }};
}

std::vector<OwnFile> own_outputs(const OutputPaths& paths) {
  std::vector<OwnFile> files;
  for (const OutputPaths::List& list : paths.lists)
    if (list.always) files.push_back(list_file(list, paths.program));
  files.insert(files.end(), {{paths.program, has_corrected_header},
                             marked_file(paths.report_json, "\"counterflex"),
                             marked_file(paths.report_csv, "index,line,cutting,s_mm"),
                             page_file(paths.report_page),
                             marked_file(paths.plot, plot_mark)});
  return files;
}

void refuse_foreign_outputs(const OutputPaths& paths) {
  refuse_part_of_other(paths.program, paths.program);
  if (!paths.force_overwrite) refuse_foreign(own_outputs(paths));
}

}  // namespace counterflex::cli
