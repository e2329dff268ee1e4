#include <algorithm>
#include <filesystem>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/file_reader.hpp"

namespace counterflex {
namespace {

std::optional<std::string> hash_of(const std::string& path) {
  std::error_code ignored;
  // Reading a pipe could block.
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  try {
    FileReader file(path);
    return sha256(file);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

const std::optional<std::string>& FileHashes::of(const std::string& path) {
  const auto [place, is_new] = known_.try_emplace(path);
  if (is_new) place->second = hash_of(path);
  return place->second;
}

bool is_proven(const JobOutcome& recorded, const std::string& key, FileHashes& on_disk) {
  const auto is_as_recorded = [&](const FileHash& file) { return on_disk.of(file.path) == file.sha256; };
  return !recorded.error_kind && recorded.key == key && !recorded.inputs.empty() &&
         !recorded.outputs.empty() && std::ranges::all_of(recorded.inputs, is_as_recorded) &&
         std::ranges::all_of(recorded.outputs, is_as_recorded);
}

}  // namespace counterflex
