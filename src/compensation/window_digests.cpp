// What tells that two runs stand at the same place, without keeping it.
#include "counterflex/files/files.hpp"
#include "vector_bytes.hpp"
#include "window_state.hpp"

namespace counterflex {
namespace {

void put_series(const SeriesState& series, std::string& bytes) {
  put(series.x.size(), bytes);
  put_vector(series.x, bytes);
  put_vector(series.x_nominal, bytes);
  put_vector(series.F, bytes);
  for (const GroupState& group : series.groups) {
    put_pose(group.X, bytes);
    for (const SeriesState& branch : group.branches) put_series(branch, bytes);
  }
}

// The tool whose model it is; -1: the machine's own.
long tool_of(const Job& job, const Model* model) {
  if (job.tools != nullptr)
    for (const auto& [tool, of_tool] : *job.tools)
      if (&of_tool == model) return tool;
  return -1;
}

// AVX2 and AVX-512 give the same bits (src/CMakeLists.txt).
std::string_view rounding() {
  const std::string_view instructions = lane_instructions();
#if defined(__GNUC__) && !defined(__clang__)
  if (instructions == "AVX-512") return "AVX2";
#endif
  return instructions;
}

// What a control reads of a move, as far as it is asked where it goes.
void put_command(const Move& move, std::string& bytes) {
  put_vector(move.end_mm, bytes);
  put(move.frame, bytes);
}

void put_way(const Move& move, std::string& bytes) {
  put_vector(move.start_mm, bytes);
  for (const bool known : move.known_start) put(known, bytes);
  put(move.motion, bytes);
  put(move.arc.has_value(), bytes);
  if (move.arc) {
    put_vector(move.arc->centre_mm, bytes);
    put(move.arc->normal, bytes);
    put(move.arc->clockwise, bytes);
    put(move.arc->turns, bytes);
  }
  put(move.cycle.has_value(), bytes);
  if (move.cycle) put(move.cycle->bottom_mm, bytes);
}

}  // namespace

std::string digest_of_start(const Job& job, const std::optional<NominalPlace>& nominal) {
  std::string bytes(rounding());
  const NominalPlace place = nominal.value_or(home_of(job.model));
  put(tool_of(job, place.model), bytes);
  put_pose(place.configuration.X_MP, bytes);
  for (const SeriesState& chain : place.configuration.chains) put_series(chain, bytes);
  return sha256(bytes);
}

std::string digest_of_commands(const Program& corrected) {
  std::string bytes;
  put(corrected.before.has_value(), bytes);
  if (corrected.before) put_command(*corrected.before, bytes);
  for (const Move& move : corrected.moves) {
    put_command(move, bytes);
    put_way(move, bytes);
  }
  return sha256(bytes);
}

}  // namespace counterflex
