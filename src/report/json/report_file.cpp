#include <fmt/core.h>

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/report/report.hpp"
#include "report/json/json_values.hpp"
#include "report/names.hpp"

namespace counterflex {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view page_schema = "counterflex-page 1";
constexpr std::string_view data_begins = R"(<script type="application/json" id="counterflex-data">)";
constexpr std::string_view data_ends = "</script>";
constexpr std::string_view byte_order_mark =
    "\xEF\xBB\xBF";  // editors may add it; the JSON of a page must not have it

std::string display_name(const std::string& path) {
  return path == "-" ? "<stdin>" : path;
}

bool is_page(const std::string& path) {
  return path.ends_with(".html");
}

/// Throws unless `document`, which begins at byte `offset` of `whole`, has this `schema`.
void require_schema(const Json& document, std::string_view schema, std::string_view whole, std::size_t offset,
                    const std::string& file) {
  const auto found = document.is_object() ? document.find("schema") : document.end();
  if (document.is_object() && found != document.end() && *found == schema) return;
  const bool any = document.is_object() && found != document.end();
  const std::size_t key = any ? whole.find("\"schema\"", offset) : offset;
  throw InputError(ErrorKind::usage, place_of(whole, key, file),
                   fmt::format("the document's schema is {}; only \"{}\" can be compared",
                               any ? found->dump() : "missing", report_schema));
}

/// The data of a page that shows one run: {"report", "curves", "loads", "source"}.
Json run_of_page(std::string_view html, const std::string& file) {
  const std::size_t tag = html.find(data_begins);
  if (tag == std::string_view::npos)
    throw InputError(ErrorKind::usage, {file, 1, 1},
                     "is not a page of counterflex: it has no counterflex-data");
  const std::size_t begin = tag + data_begins.size();
  const std::string_view data = html.substr(begin, html.find(data_ends, begin) - begin);
  const Json page = parse_json(data, html, begin, file);
  require_schema(page, page_schema, html, begin, file);
  const Json* runs = JsonSource{page, file}.list("/runs");
  const std::size_t count = runs == nullptr ? 0 : runs->size();
  if (count != 1)
    throw InputError(ErrorKind::usage, {file},
                     fmt::format("the page shows {} runs; give the page of a single run", count));
  return runs->front();
}

std::string text_of_part(const Json& run, const char* part) {
  const auto found = run.find(part);
  return found == run.end() || found->is_null() ? "" : found->dump();
}

void take_curves(const Json& run, ReportFile& file) {
  file.curves = text_of_part(run, "curves");
  file.loads = text_of_part(run, "loads");
  file.machine = text_of_part(run, "machine");
  file.source = text_of_part(run, "source");
}

ReportFile read_page(const std::string& path, WithCurves with) {
  const std::string html = read_file(path);
  const Json run = run_of_page(html, path);
  const Json* report = JsonSource{run, path}.object("/report");
  require_schema(report == nullptr ? Json() : *report, report_schema, html, html.find(data_begins), path);
  ReportFile file{.path = path, .sha256 = sha256(html), .report = dump(*report)};
  if (with == WithCurves::yes) take_curves(run, file);
  return file;
}

/// Errors of the page become remarks: the reports are compared without its curves.
void look_beside(const Json& report, ReportFile& file) {
  const std::string page = page_beside(file.path);
  std::error_code ignored;
  if (page.empty() || !fs::exists(page, ignored)) {
    file.remark = "its page STEM.html, beside STEM.json, is missing: the comparison has no curves of it";
    return;
  }
  try {
    const Json run = run_of_page(read_file(page), page);
    // The order of keys does not matter.
    if (run.contains("report") && nlohmann::json(run["report"]) == nlohmann::json(report))
      take_curves(run, file);
    else
      file.remark = fmt::format("{} shows another report: the comparison has no curves of it", page);
  } catch (const InputError& error) {
    file.remark = fmt::format("the comparison has no curves of it: {}", error.what());
  }
}

ReportFile read_json(const std::string& path, WithCurves with) {
  const std::string name = display_name(path);
  const std::string text = read_file(path);
  const std::size_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  const std::string_view document = std::string_view(text).substr(begin);
  const Json report = parse_json(document, text, begin, name);
  require_schema(report, report_schema, text, begin, name);
  ReportFile file{.path = name, .sha256 = sha256(text), .report = std::string(document)};
  if (with == WithCurves::yes) look_beside(report, file);
  return file;
}

}  // namespace

std::string page_beside(const std::string& path) {
  if (!path.ends_with(".json")) return "";
  return fs::path(path).replace_extension(".html").generic_string();
}

ReportFile read_report_file(const std::string& path, WithCurves with) {
  ReportFile file = is_page(path) ? read_page(path, with) : read_json(path, with);
  file.name = path == "-" ? "stdin" : fs::path(path).stem().generic_string();
  return file;
}

void tell_apart(ReportFile& a, ReportFile& b) {
  fs::path folder_a = fs::path(a.path).parent_path(), folder_b = fs::path(b.path).parent_path();
  while (a.name == b.name && (folder_a.has_filename() || folder_b.has_filename())) {
    if (folder_a.has_filename()) a.name = (folder_a.filename() / a.name).generic_string();
    if (folder_b.has_filename()) b.name = (folder_b.filename() / b.name).generic_string();
    folder_a = folder_a.parent_path();
    folder_b = folder_b.parent_path();
  }
  if (a.name != b.name) return;
  a.name += " (1)";
  b.name += " (2)";
}

}  // namespace counterflex
