#include "counterflex/batch/manifest.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "batch/job_line.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr std::string_view beginning = "{\"format\":\"counterflex-manifest ", known_format = "2";
constexpr std::string_view end_of_jobs = "],", beginning_of_sum = "\"sha256\":\"", end_of_sum = "\"}";

std::string first_line(const std::string& version, const std::string& plan) {
  const auto quoted = [](const std::string& bytes) { return nlohmann::json(utf8_of_bytes(bytes)).dump(); };
  return fmt::format("{}{}\",\"version\":{},\"plan\":{},\"jobs\":[", beginning, known_format, quoted(version),
                     quoted(plan));
}

/// Reads a manifest line by line.
class ManifestLines {
 public:
  ManifestLines(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  /// The next line without its end, which each line must have.
  std::string_view next() {
    ++line_;
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) refuse(rest_.size() + 1, "the file ends here: it was cut off");
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }

  std::string_view rest() const { return rest_; }
  int line() const { return line_; }

  [[noreturn]] void refuse(std::size_t column, const std::string& what) const {
    throw InputError(ErrorKind::machine_or_force, {file_, line_, static_cast<int>(column)},
                     what +
                         "; nothing was changed; to run the jobs of this manifest again, remove it or run "
                         "without --resume");
  }

 private:
  std::string_view rest_;
  std::string file_;
  int line_ = 0;
};

void check_format(std::string_view line, const ManifestLines& lines) {
  if (!line.starts_with(beginning))
    lines.refuse(1, fmt::format("this is not a manifest of a batch; a manifest begins with {}", beginning));
  const std::string_view format =
      line.substr(beginning.size(), line.find('"', beginning.size()) - beginning.size());
  if (format != known_format)
    lines.refuse(beginning.size() + 1, fmt::format("the manifest's format is '{}', this program reads {}",
                                                   utf8_of_bytes(format), known_format));
}

Manifest read_head(ManifestLines& lines) {
  const std::string_view line = lines.next();
  check_format(line, lines);
  const auto head = nlohmann::json::parse(std::string(line) + "]}", nullptr, /*allow_exceptions=*/false);
  Manifest manifest;
  const auto text = [&](const char* key) {
    return head.is_object() && head.contains(key) && head[key].is_string()
               ? bytes_of_utf8(head[key].get<std::string>())
               : "";
  };
  manifest.version = text("version");
  manifest.plan = text("plan");
  if (line != first_line(manifest.version, manifest.plan))
    lines.refuse(1, "the line is not as counterflex writes it");
  return manifest;
}

JobOutcome read_job(std::string_view line, const ManifestLines& lines, ExitStatusOf exit_status) {
  auto read = read_job_line(line, exit_status);
  if (const auto* trouble = std::get_if<LineTrouble>(&read)) lines.refuse(trouble->column, trouble->what);
  return std::get<JobOutcome>(std::move(read));
}

/// The outputs of a job, with its corrected program even if it failed.
std::set<std::string> written_by(const JobOutcome& job) {
  std::set<std::string> paths{job.output};
  for (const FileHash& file : job.outputs) paths.insert(file.path);
  return paths;
}

void read_jobs(ManifestLines& lines, Manifest& manifest, ExitStatusOf exit_status) {
  std::set<std::string> written;
  std::string_view line = lines.next();
  for (bool is_last = line == end_of_jobs; !is_last; line = lines.next()) {
    is_last = !line.ends_with(',');
    manifest.jobs.push_back(read_job(is_last ? line : line.substr(0, line.size() - 1), lines, exit_status));
    for (const std::string& path : written_by(manifest.jobs.back()))
      if (!written.insert(path).second)
        lines.refuse(1, fmt::format("two jobs write {}", utf8_of_bytes(path)));
  }
  if (line != end_of_jobs)
    lines.refuse(1, fmt::format("the line after the last job must be {}", end_of_jobs));
}

void check_sum(ManifestLines& lines, std::string_view text) {
  const std::string_view summed = text.substr(0, text.size() - lines.rest().size()), line = lines.next();
  const std::string sum = sha256(summed);
  if (!line.starts_with(beginning_of_sum) || !line.ends_with(end_of_sum))
    lines.refuse(1, "the last line must hold the sum of the lines before it");
  if (line != fmt::format("{}{}{}", beginning_of_sum, sum, end_of_sum))
    lines.refuse(
        beginning_of_sum.size() + 1,
        fmt::format("the manifest was changed: the SHA-256 of the lines before this one is {}", sum));
  if (!lines.rest().empty()) {
    (void)lines.next();
    lines.refuse(1, "there is text after the end of the manifest");
  }
}

}  // namespace

std::string to_text(const Manifest& manifest, ExitStatusOf exit_status) {
  std::string text = first_line(manifest.version, manifest.plan) + '\n';
  for (const JobOutcome& job : manifest.jobs) {
    text += to_json_line(job, exit_status);
    text += &job == &manifest.jobs.back() ? "\n" : ",\n";
  }
  text += fmt::format("{}\n", end_of_jobs);
  return text + fmt::format("{}{}{}\n", beginning_of_sum, sha256(text), end_of_sum);
}

Manifest read_manifest(std::string_view text, const std::string& file, ExitStatusOf exit_status) {
  ManifestLines lines(text, file);
  Manifest manifest = read_head(lines);
  read_jobs(lines, manifest, exit_status);
  check_sum(lines, text);
  return manifest;
}

}  // namespace counterflex
