#include "run/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/machine_drawing.hpp"
#include "counterflex/report/map.hpp"
#include "counterflex/report/page.hpp"
#include "counterflex/report/report.hpp"
#include "process/signals.hpp"
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

void check_paths(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& made = {}) {
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

/// Whether `mark` is in the first bytes of a file.
bool begins_with_mark(const std::string& path, std::string_view mark) {
  constexpr std::size_t looked_at = 1 << 14;
  std::string bytes;
  FileReader(path).append(bytes, looked_at);
  return bytes.find(mark) != std::string::npos;
}

void make_folders(const std::vector<std::string>& folders) {
  for (const std::string& folder : folders)
    if (!folder.empty()) make_folder(folder);
}

/// Removes unfinished files of killed runs.
void sweep_left(const OutputPaths& paths) {
  std::vector<std::string> files{paths.program, paths.report_json, paths.report_csv, paths.report_page,
                                 paths.plot};
  for (const OutputPaths::List& list : paths.lists) files.push_back(list.path);
  std::erase_if(files, [](const std::string& path) { return path.empty() || path == "-"; });
  sweep_abandoned(files);
}

/// A divided program calls its parts by name: another program under this name would run instead.
void refuse_part_of_other(const std::string& file, const std::string& program) {
  const std::string divided = divided_program_of(file);
  if (divided.empty() || is_same_file(divided, program)) return;
  throw InputError(ErrorKind::usage, {file},
                   fmt::format("the file is a part of the divided program {}, which calls it; write into "
                               "another folder, or remove both files",
                               without_controls(divided)));
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

std::string path_of_plot(const std::string& path) {
  if (fs::path(path).extension() != ".svg")
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--plot writes a file that ends in .svg, not '{}'", path));
  return path;
}

}  // namespace

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
  if (options.plot) outputs.push_back(paths.plot = path_of_plot(*options.plot));
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

namespace {

/// A corrected data list: it has no header of its own.
OwnFile list_file(const OutputPaths::List& list, const std::string& corrected) {
  return {list.path, [corrected](const std::string&) { return has_corrected_header(corrected); }};
}

}  // namespace

void refuse_foreign_outputs(const OutputPaths& paths, const Options& options) {
  refuse_part_of_other(paths.program, paths.program);
  if (options.force_overwrite) return;
  for (const OutputPaths::List& list : paths.lists)
    if (list.always) refuse_foreign({list_file(list, paths.program)});
  refuse_foreign({{paths.program, has_corrected_header},
                  marked_file(paths.report_json, "\"counterflex"),
                  marked_file(paths.report_csv, "index,line,cutting,s_mm"),
                  page_file(paths.report_page),
                  marked_file(paths.plot, plot_mark)});
}

ComparisonPaths comparison_paths(const Options& options) {
  if (!options.report) return {};
  ComparisonPaths paths{stem_of_report(options) + ".json", stem_of_report(options) + ".html"};
  std::vector<std::string> inputs = options.compare.reports;
  for (const std::string& report : options.compare.reports)
    if (const std::string page = page_beside(report); !page.empty()) inputs.push_back(page);
  check_paths({paths.json, paths.page}, inputs);
  if (!options.force_overwrite)
    refuse_foreign({marked_file(paths.json, "\"counterflex-comparison"), page_file(paths.page)});
  return paths;
}

void check_output(const Options& options, std::string_view mark) {
  if (!options.output) return;
  if (*options.output == "-" && options.json)
    throw InputError(
        ErrorKind::usage, {},
        "the table and the document of --json cannot both go to standard output; give -o a file");
  check_paths({*options.output}, inputs_of(options));
  const std::string extension = fs::path(*options.output).extension().generic_string();
  if (*options.output != "-" && extension != ".csv")
    throw InputError(ErrorKind::usage, {*options.output},
                     fmt::format("a table is written to a .csv file, not to '{}'", extension));
  if (!options.force_overwrite) refuse_foreign({marked_file(*options.output, mark)});
}

namespace {

/// Of files that people edit.
void refuse_existing(const std::string& output, bool overwrite) {
  std::error_code error;
  if (overwrite || !fs::is_regular_file(output, error) || fs::file_size(output, error) == 0) return;
  throw InputError(ErrorKind::usage, {output},
                   "the file exists; give another name, or --force-overwrite to replace it");
}

}  // namespace

void check_machine_output(const std::string& output, const std::vector<std::string>& inputs, bool overwrite) {
  if (output.empty() || output == "-") return;
  check_paths({output}, inputs);
  if (fs::path(output).extension() != ".toml")
    throw InputError(ErrorKind::usage, {output}, "a machine file has a name that ends in .toml");
  refuse_existing(output, overwrite);
}

void check_coupon_outputs(const Options& options) {
  const std::string &program = *options.output, &sheet = *options.testcut.sheet;
  for (const std::string& path : {program, sheet})
    if (path == "-")
      throw InputError(ErrorKind::usage, {}, "testcut writes two files; -o and --sheet cannot be '-'");
  check_paths({program, sheet}, inputs_of(options));
  if (fs::path(sheet).extension() != ".csv")
    throw InputError(ErrorKind::usage, {sheet}, "a sheet has a name that ends in .csv");
  refuse_existing(sheet, options.force_overwrite);
  refuse_part_of_other(program, program);
  if (!options.force_overwrite) refuse_foreign({{program, has_corrected_header}});
}

namespace {

void refuse_no_svg(std::string_view option, const std::string& path) {
  if (fs::path(path).extension() != ".svg")
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{} writes a file that ends in .svg, not '{}'", option, path));
}

}  // namespace

void check_map_outputs(const Options& options) {
  check_output(options, map_table_mark);
  if (!options.map.plot) return;
  const std::string& path = *options.map.plot;
  refuse_no_svg("--plot", path);
  check_paths({path}, inputs_of(options));
  if (!options.force_overwrite) refuse_foreign({marked_file(path, map_picture_mark)});
}

void check_drawing_output(const Options& options) {
  const std::string& path = *options.check.draw;
  refuse_no_svg("--draw", path);
  check_paths({path}, options.check.files);
  if (!options.force_overwrite) refuse_foreign({marked_file(path, drawing_mark)});
}

RunFiles::RunFiles(const OutputPaths& paths, const CsvColumns& columns, bool hashed)
    : paths_(paths), columns_(columns) {
  make_folders(paths.folders);
  sweep_left(paths);
  const auto open = [&](std::optional<FileWriter>& file, const std::string& path) {
    if (path.empty()) return;
    file.emplace(path);
    if (hashed) file->hash_along();
  };
  open(program_, paths.program);
  for (const OutputPaths::List& list : paths.lists) lists_.emplace_back(list.path).hash_along();
  if (!lists_.empty())
    splitter_.emplace([this](std::size_t file, std::string_view bytes) {
      if (counted_ && file == 0) counted_->program += bytes;
      if (counted_ && file == 1) counted_->list.write(bytes);
      if (counted_) return;
      (file == 0 ? *program_ : lists_.at(file - 1)).write(bytes);
    });
  open(plot_, paths.plot);
  open(csv_, paths.report_csv);
  open(json_, paths.report_json);
  open(page_, paths.report_page);
  if (csv_) csv_->write(csv_header(columns));
  if (paths.take_rows) paths.take_rows(csv_header(columns));
}

void RunFiles::write_held() {
  const std::string text = std::move(*held_);
  held_.reset();
  add_program(text);
}

void RunFiles::write_parts(const std::vector<ProgramPart>& parts, const std::vector<std::string>& paths) {
  held_.reset();
  program_->write(parts.front().text);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    FileWriter& file = parts_.emplace_back(paths[i]);
    file.hash_along();
    file.write(parts[i + 1].text);
  }
}

void RunFiles::add_program(std::string_view text) {
  if (held_)
    held_->append(text);
  else if (splitter_)
    splitter_->add(text);
  else if (program_)
    program_->write(text);
  if (!held_ && paths_.take_program) paths_.take_program(text);
}

void RunFiles::add_waypoints(const std::vector<Waypoint>& waypoints) {
  constexpr std::size_t at_once = 256;  // rows; one has half a kilobyte
  if (!csv_ && !paths_.take_rows) return;
  for (std::span<const Waypoint> rest(waypoints); !rest.empty();) {
    const auto some = rest.first(std::min(at_once, rest.size()));
    const std::string rows = csv_rows(some, columns_, next_row_);
    if (csv_) csv_->write(rows);
    if (paths_.take_rows) paths_.take_rows(rows);
    rest = rest.subspan(some.size());
  }
}

void RunFiles::add_report(const RunReport& report, const std::string& report_json, const PathCurves& curves,
                          const std::string& machine, FileReader& program) {
  if (json_) json_->write(report_json);
  if (plot_) plot_->write(to_svg(curves, report));
  if (!page_) return;
  std::vector<PageRun> runs(1);
  runs[0].report = report_json;
  runs[0].curves = curves_json(curves);
  runs[0].loads = loads_json(report.loads);
  runs[0].machine = machine;
  runs[0].source = source_json(program, report);
  runs[0].offsets = offsets_html(report);
  write_page(
      page_title(report), runs, [&](std::string_view part) { page_->write(part); }, "",
      report.facts.proof ? proof_sheet(report) : "");
}

void RunFiles::refuse_changed(const OutputPaths::List& list) const {
  if (paths_.job_files != nullptr) paths_.job_files->refuse_others(list.path, paths_.program);
  if (!paths_.force_overwrite) refuse_foreign({list_file(list, paths_.program)});
}

std::vector<FileWriter*> RunFiles::written_lists() {
  std::vector<FileWriter*> lists;
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    lists_[i].complete();
    const OutputPaths::List& list = paths_.lists[i];
    FileReader input(list.input);
    const bool changed = lists_[i].sha256() != sha256(input);
    if (changed && belongs_to_control(list.input))
      throw InputError(
          ErrorKind::program_text, {list.input},
          "a target in this list is corrected, but all programs of the control use the list; copy "
          "the target into the data list of the program");
    if (changed && !list.always) refuse_changed(list);
    if (changed || list.always) lists.push_back(&lists_[i]);
  }
  return lists;
}

void RunFiles::write_counted() {
  LoopCount count = loop_count_of(counted_->program);
  counted_->list.read([&](const std::string& lines) { add_elements(lines, count); });
  program_->write(with_loop_end(std::move(counted_->program), count));
  counted_->list.read(
      [&](std::string lines) { lists_.at(0).write(with_array_size(std::move(lines), count)); });
  counted_.reset();
}

std::vector<FileHash> RunFiles::complete_program() {
  if (!completed_lists_) {
    if (splitter_) splitter_->finish();
    if (counted_) write_counted();
    completed_lists_ = written_lists();
  }
  std::vector<FileWriter*> files{if_any(program_)};
  files.insert(files.end(), completed_lists_->begin(), completed_lists_->end());
  for (FileWriter& part : parts_) files.push_back(&part);
  std::vector<FileHash> hashes;
  for (FileWriter* file : files) {
    if (file == nullptr) continue;
    file->complete();
    hashes.push_back({file->path(), file->sha256()});
  }
  return hashes;
}

void RunFiles::publish(bool with_program) {
  std::vector<FileWriter*> files{if_any(json_), if_any(csv_), if_any(page_), if_any(plot_)};
  if (with_program) {
    complete_program();
    files.insert(files.begin(), completed_lists_->begin(), completed_lists_->end());
    for (FileWriter& part : parts_) files.push_back(&part);
    files.push_back(if_any(program_));
  }
  publish_together(files);
  if (with_program) std::rotate(files.begin(), files.end() - 1, files.end());  // the program is listed first
  for (const FileWriter* file : files)
    if (file != nullptr && !file->is_stream()) published_.push_back({file->path(), file->sha256()});
}

FileWriter* if_any(std::optional<FileWriter>& file) {
  return file ? &*file : nullptr;
}

void publish_together(std::vector<FileWriter*> files) {
  std::erase(files, nullptr);
  for (FileWriter* file : files) file->complete();
  // The reader of a stream may be slow or close it: interrupts must work meanwhile.
  for (FileWriter* file : files)
    if (file->is_stream()) file->publish();
  std::erase_if(files, [](const FileWriter* file) { return file->is_stream(); });
  const HeldSignals held;
  FileWriter::publish_files(files);
}

}  // namespace counterflex::cli
