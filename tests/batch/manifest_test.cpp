#include "counterflex/batch/manifest.hpp"

#include <algorithm>

#include "batch/outcomes.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The refusal of `text` without its advice, or "read".
std::string refusal(const std::string& text) {
  try {
    (void)read_manifest(text, "m.json", status_of);
    return "read";
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    CHECK(error.where().line > 0);
    CHECK(error.where().column > 0);
    const std::string what = error.what();
    CHECK(what.find("run without --resume") != std::string::npos);
    return what.substr(0, what.find(';'));
  }
}

/// `text` with a correct sum, as after a deliberate change of a manifest.
std::string summed(std::string text) {
  text.resize(text.rfind("\"sha256\":\""));
  return text + fmt::format("\"sha256\":\"{}\"}}\n", sha256(text));
}

std::string with(std::string text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), now);
}

}  // namespace

TEST_CASE("reading a written manifest restores it, with jobs and without") {
  for (const int jobs : {0, 1, 2, 50}) {
    CAPTURE(jobs);
    const Manifest manifest = made_up_manifest(jobs);
    CHECK(read_manifest(to_text(manifest, status_of), "m.json", status_of) == manifest);
  }
}

TEST_CASE("a manifest has one job per line, between one line before and two after") {
  const std::string text = to_text(made_up_manifest(5), status_of);
  CHECK(std::count(text.begin(), text.end(), '\n') == 5 + 3);
  CHECK(text.find('\n' + to_json_line(made_up_outcome(1), status_of) + ",\n") != std::string::npos);
}

TEST_CASE("a truncated manifest is refused at its end") {
  const std::string text = to_text(made_up_manifest(3), status_of);
  for (std::size_t size = 0; size < text.size(); ++size) {
    CAPTURE(size);
    const std::string begun = text.substr(0, size), refused = refusal(begun);
    const auto lines = std::count(begun.begin(), begun.end(), '\n');
    const std::size_t in_line = size - (begun.rfind('\n') + 1);
    CHECK(refused ==
          fmt::format("m.json:{}:{}: error: the file ends here: it was cut off", lines + 1, in_line + 1));
  }
}

TEST_CASE("a manifest with a changed, added or missing byte is refused") {
  const std::string text = to_text(made_up_manifest(4), status_of);
  std::mt19937 random(11);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string changed = text;
    const std::size_t at = random() % text.size();
    const auto flip = static_cast<char>(1 + random() % 255);
    if (trial % 3 == 0) changed[at] = static_cast<char>(changed[at] ^ flip);
    if (trial % 3 == 1) changed.insert(at, 1, flip);
    if (trial % 3 == 2) changed.erase(at, 1 + random() % 3);
    CAPTURE(trial);
    CAPTURE(at);
    CHECK(refusal(changed) != "read");
  }
}

TEST_CASE("a change with the right sum is refused, too, unless it is a manifest") {
  const Manifest manifest = made_up_manifest(4);
  const std::string text = to_text(manifest, status_of);
  CHECK(summed(text) == text);
  std::mt19937 random(12);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string changed = text;
    const std::size_t at = random() % text.rfind("\"sha256\":\"");
    changed[at] = static_cast<char>(changed[at] ^ (1 + random() % 127));
    changed = summed(changed);
    CAPTURE(trial);
    CAPTURE(at);
    std::string taken = changed;
    try {
      taken = to_text(read_manifest(changed, "m.json", status_of), status_of);
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::machine_or_force);
    }
    CHECK(taken == changed);
  }
}

TEST_CASE("a refusal names the place and the text there") {
  const std::string text = to_text(made_up_manifest(2), status_of);
  CHECK(refusal("{}\n").starts_with("m.json:1:1: error: this is not a manifest of a batch"));
  CHECK(refusal(with(text, "manifest 2", "manifest 1")) ==
        "m.json:1:33: error: the manifest's format is '1', this program reads 2");
  CHECK(refusal(with(text, "\"plan\"", "\"plot\"")) ==
        "m.json:1:1: error: the line is not as counterflex writes it");
  CHECK(refusal(with(text, "\"exit\":0", "\"exit\":0 ")) ==
        fmt::format("m.json:2:{}: error: the line is not as counterflex writes it",
                    text.find(",\"verdict\"") - text.find('\n')));
  CHECK(refusal(with(text, "\"exit\":0", "\"exit\":")).starts_with("m.json:2:"));
  CHECK(refusal(with(text, "\"exit\":0", "\"exit\":5")) ==
        "m.json:2:1: error: the line is not that of a job: no job ends with exit status 5");
  CHECK(refusal(with(text, "\"exit\":0", "\"exit\":60"))
            .starts_with("m.json:5:11: error: the manifest was changed: the SHA-256 of the lines before"));
  CHECK(refusal(text + "\n") == "m.json:6:1: error: there is text after the end of the manifest");
}

TEST_CASE("two jobs that write one file are refused at the second") {
  Manifest same_program = made_up_manifest(4);
  same_program.jobs[2].output = same_program.jobs[0].output;
  CHECK(refusal(to_text(same_program, status_of)) == "m.json:4:1: error: two jobs write corrected/O1000.ngc");
  Manifest same_report = made_up_manifest(4);
  for (const int job : {1, 3}) same_report.jobs[job].outputs.push_back({"corrected/r.json", sha256("r")});
  CHECK(refusal(to_text(same_report, status_of)) == "m.json:5:1: error: two jobs write corrected/r.json");
}

TEST_CASE("the format is the one that is documented") {
  Manifest manifest{.version = "0.1.0", .plan = "p", .jobs = {JobOutcome{.key = "k", .program = "a%b"}}};
  manifest.jobs[0].inputs = {{"i", "h"}};
  const std::string lines =
      "{\"format\":\"counterflex-manifest 2\",\"version\":\"0.1.0\",\"plan\":\"p\",\"jobs\":[\n"
      "{\"key\":\"k\",\"program\":\"a%25b\",\"output\":\"\",\"exit\":0,\"verdict\":\"FAILED\",\"verdict_"
      "reason\":\"\",\"error\":\"\","
      "\"inputs\":[{\"path\":\"i\",\"sha256\":\"h\"}],\"outputs\":[],\"before_mm\":null,\"after_mm\":null,"
      "\"corrected_percent\":null,\"warnings\":null,\"moves\":null}\n"
      "],\n";
  CHECK(to_text(manifest, status_of) == lines + "\"sha256\":\"" + sha256(lines) + "\"}\n");
}

namespace {

/// A finished job with two input and two output files in a folder.
struct DoneJob {
  Folder folder;
  JobOutcome outcome = made_up_outcome(0);
  DoneJob() {
    outcome.inputs = {written("a.ngc"), written("m.toml")};
    outcome.outputs = {written("b.ngc"), written("b.json")};
  }
  FileHash written(const std::string& name) {
    write_file(folder.file(name), "bytes of " + name);
    return {folder.file(name), sha256("bytes of " + name)};
  }
  bool proven() const {
    FileHashes on_disk;
    return is_proven(outcome, outcome.key, on_disk);
  }
};

}  // namespace

TEST_CASE("a job is unchanged if its key and all its files are") {
  const DoneJob job;
  CHECK(job.proven());
  FileHashes on_disk;
  CHECK(!is_proven(job.outcome, sha256("other options"), on_disk));
}

TEST_CASE("a job that failed, or whose files are unknown, is not unchanged") {
  for (int what = 0; what < 3; ++what) {
    DoneJob job;
    if (what == 0) job.outcome.error_kind = ErrorKind::not_compensated;
    if (what == 1) job.outcome.inputs.clear();
    if (what == 2) job.outcome.outputs.clear();
    CAPTURE(what);
    CHECK(!job.proven());
  }
}

TEST_CASE("a job with a changed or missing file, or a folder in its place, is not unchanged") {
  for (const char* name : {"a.ngc", "m.toml", "b.ngc", "b.json"}) {
    CAPTURE(name);
    const DoneJob job;
    write_file(job.folder.file(name), "bytes of another");
    CHECK(!job.proven());
    std::filesystem::remove(job.folder.file(name));
    CHECK(!job.proven());
    std::filesystem::create_directory(job.folder.file(name));
    CHECK(!job.proven());
    std::filesystem::remove(job.folder.file(name));
    REQUIRE(::mkfifo(job.folder.file(name).c_str(), 0600) == 0);
    CHECK(!job.proven());
  }
}

TEST_CASE("a file shared by jobs is hashed only once") {
  const Folder folder;
  write_file(folder.file("m.toml"), "first");
  FileHashes on_disk;
  CHECK(on_disk.of(folder.file("m.toml")) == sha256("first"));
  write_file(folder.file("m.toml"), "second");
  CHECK(on_disk.of(folder.file("m.toml")) == sha256("first"));
  CHECK(!on_disk.of("-"));
}
