#include "part.hpp"

#include <bit>
#include <mutex>

#include "counterflex/compensation/recorded_windows.hpp"
#include "counterflex/files/sha256.hpp"
#include "counterflex/program/last_words.hpp"

namespace counterflex::cli {
namespace {

class RunDigest {
 public:
  /// Texts with their lengths, so that none runs into the next.
  void add(std::string_view text) {
    hash_.add(std::to_string(text.size()) + ":");
    hash_.add(text);
  }
  /// All bits of a number.
  void add(double value) { add(std::to_string(std::bit_cast<std::uint64_t>(value))); }
  std::string digits() { return hash_.digits(); }

 private:
  Sha256 hash_;
};

/// Part `p` of `parts` equal ones.
Span bytes_of(const PartOfProgram& part, std::size_t size) {
  const auto p = static_cast<std::size_t>(part.part), parts = static_cast<std::size_t>(part.parts);
  const auto begin = [&](std::size_t k) { return size / parts * k + size % parts * k / parts; };
  return {begin(p), begin(p + 1)};
}

}  // namespace

std::string digest_of(const Run& run) {
  RunDigest digest;
  digest.add(run.facts.version);
  digest.add(std::to_string(window_moves));
  digest.add(std::string_view(run.facts.attribution ? "attribution" : ""));
  for (const InputFile& input : run.facts.inputs) {
    digest.add(input.name);
    digest.add(input.sha256);
  }
  for (const OptionValue& option : run.facts.options) {
    digest.add(option.name);
    std::visit([&](const auto& value) { digest.add(value); }, option.value);
  }
  for (const double value : {run.options.tolerance, run.options.max_correction, run.options.blend})
    digest.add(value);
  for (const std::string& line : run.options.write.header) digest.add(line);
  return digest.digits();
}

Exit record_part(const Options& options, Console& console, const std::function<void(const Run&)>& tell) {
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  prepare_writing(options, *run);
  RecordedPart part{bytes_of(*options.part, run->file.bytes.size())};
  part.last_words = last_words_before(part.bytes.begin, run->file.bytes, run->program.file, run->read);
  Windows windows(*run, console);
  std::mutex speaking;
  const auto read = [&](const Job& job) {
    const std::lock_guard alone(speaking);
    windows.check(job);
  };
  const auto solved = [&](const Job&, const std::vector<Waypoint>& waypoints) {
    const std::lock_guard alone(speaking);
    console.solved(waypoints.size());
  };
  FileWriter file =
      record_windows(windows.jobs(), run->options, TextReader(windows.reader()), run->facts.attribution, part,
                     digest_of(*run), options.part->file, {read, [](const Job&) {}, solved, [](const Job&, const Compensation&) {}});
  run->file.bytes.refuse_change();  // it was read more than once
  publish_together({&file});
  tell(*run);
  return Exit::done;
}

}  // namespace counterflex::cli
