#include "run/run_files.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/report/page.hpp"
#include "counterflex/report/report.hpp"
#include "process/signals.hpp"
#include "run/header/corrected_header.hpp"
#include "run/proof.hpp"

namespace counterflex::cli {

namespace {

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

}  // namespace

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

void RunFiles::refuse_foreign_of(const std::vector<FileWriter*>& files) const {
  if (paths_.force_overwrite) return;
  std::vector<OwnFile> own = own_outputs(paths_);
  for (const FileWriter& part : parts_)
    own.push_back(
        {part.path(), [this](const std::string& file) { return are_of_one_program(file, paths_.program); }});
  std::erase_if(own, [&](const OwnFile& output) {
    return std::none_of(files.begin(), files.end(), [&](const FileWriter* file) {
      return file != nullptr && file->path() == output.path;
    });
  });
  refuse_foreign(own);
}

void RunFiles::publish(bool with_program) {
  std::vector<FileWriter*> files{if_any(json_), if_any(csv_), if_any(page_), if_any(plot_)};
  if (with_program) {
    complete_program();
    files.insert(files.begin(), completed_lists_->begin(), completed_lists_->end());
    for (FileWriter& part : parts_) files.push_back(&part);
    files.push_back(if_any(program_));
  }
  for (FileWriter* file : files)
    if (file != nullptr) file->complete();
  refuse_foreign_of(files);
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
