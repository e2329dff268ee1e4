#include "batch_manifest.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "inputs.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

constexpr std::chrono::milliseconds between_saves(500);

}  // namespace

BatchManifest::BatchManifest(std::string path, std::string plan, std::vector<KeptUnit> units)
    : path_(std::move(path)), plan_(std::move(plan)), units_(std::move(units)), outcomes_(units_.size()) {}

std::vector<std::optional<JobOutcome>> BatchManifest::recorded(bool failed_too) const {
  std::vector<std::optional<JobOutcome>> outcomes(units_.size());
  std::error_code missing;
  if (!std::filesystem::exists(path_, missing)) return outcomes;
  const Manifest manifest = read_manifest(read_input(path_, Exit::machine_or_force), path_);
  if (manifest.version != version) return outcomes;
  std::map<std::string, const JobOutcome*> by_output;
  for (const JobOutcome& outcome : manifest.jobs) by_output[outcome.output] = &outcome;
  FileHashes on_disk;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const auto found = by_output.find(units_[i].output);
    if (found == by_output.end() || found->second->key != units_[i].key) continue;
    const bool failed = found->second->exit != Exit::done;
    if (failed ? failed_too : is_proven(*found->second, units_[i].key, on_disk)) outcomes[i] = *found->second;
  }
  return outcomes;
}

void BatchManifest::take_proven() {
  outcomes_ = recorded(false);
}

bool BatchManifest::take_all_ended() {
  auto outcomes = recorded(true);
  const bool all = std::all_of(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.has_value(); });
  if (all) outcomes_ = std::move(outcomes);
  return all;
}

void BatchManifest::set(std::size_t unit, JobOutcome outcome) {
  outcomes_[unit] = std::move(outcome);
  changed_ = true;
}

std::vector<JobOutcome> BatchManifest::ended() const {
  std::vector<JobOutcome> ended;
  for (const auto& outcome : outcomes_)
    if (outcome) ended.push_back(*outcome);
  return ended;
}

void BatchManifest::save_sometimes() {
  if (!changed_ || std::chrono::steady_clock::now() - saved_ < between_saves) return;
  try {
    save();
  } catch (const InputError&) {
    saved_ = std::chrono::steady_clock::now();  // not at once again
  }
}

void BatchManifest::save() {
  if (!changed_) return;
  write_file(path_, to_text({version, plan_, ended()}));
  changed_ = false;
  saved_ = std::chrono::steady_clock::now();
}

}  // namespace counterflex::cli
