/// Fuzz target for whole runs of small programs: `verify` accepts what `compensate` writes. On a machine
/// whose frame is displaced, where every position is known, all moves are the original ones, shifted. On a
/// machine that is rotated and whose axes are not square the correction differs from place to place, and
/// moves are split.
#include <string>
#include <utility>

#include "compensation/support/one_window.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "dialects.hpp"
#include "fuzz.hpp"

namespace counterflex::fuzz {
namespace {

constexpr std::size_t longest = 512;  // bytes: each move is solved
constexpr std::size_t longest_expansion = 250'000;
const Vector3 shift_mm(-0.5, 0.25, -0.125);

Model gantry(const std::string& errors) {
  return prepare(read_machine(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[[chain]]
name = "axes"
elements = [
  { error = "mount" },
  { actuator = "prismatic", axis = "x", min_mm = -5000, max_mm = 5000 },
  { error = "y_to_x" },
  { actuator = "prismatic", axis = "y", min_mm = -5000, max_mm = 5000 },
  { actuator = "prismatic", axis = "z", min_mm = -5000, max_mm = 5000 },
]
)" + errors,
                              "gantry.toml"));
}

const Model& displaced() {
  static const Model model = gantry("errors.mount = { xyz_mm = [0.5, -0.25, 0.125] }\n");
  return model;
}

// By 1 µm per millimetre.
const Model& turned() {
  static const Model model = gantry(
      "errors.mount = { xyz_mm = [0.5, -0.25, 0.125], rpy_deg = [0.02, -0.03, 0.05] }\n"
      "errors.y_to_x = { rpy_deg = [0, 0, 0.02] }\n");
  return model;
}

bool every_position_is_known(const Program& program) {
  if (!program.left_alone.empty()) return false;
  for (const Move& move : program.moves)
    if (!all_known(move.known_end) || move.handling != Handling::own || move.cycle || !move.may_insert_words)
      return false;
  return true;
}

// A displaced frame needs no points: the moves are the same at another place. Words have at least three
// decimals.
void demand_shifted(const Program& original, const Program& corrected) {
  constexpr double rounding_mm = 0.02;  // inches with few digits, and arcs whose centre has to be refitted
  demand(corrected.moves.size() >= original.moves.size());
  std::size_t j = 0;
  for (const Move& move : original.moves) {
    const auto is_it = [&](const Move& found) {
      return found.motion == move.motion && (found.end_mm - move.end_mm - shift_mm).norm() < rounding_mm;
    };
    while (j < corrected.moves.size() && !is_it(corrected.moves[j])) ++j;
    demand(j < corrected.moves.size());
    if (move.arc && corrected.moves[j].arc) demand(corrected.moves[j].arc->clockwise == move.arc->clockwise);
    ++j;
  }
}

// Any exception here is a defect: written text can be read.
void verify_written(const Job& job, std::string text, bool is_displaced) noexcept {
  const Program corrected = read_program(std::move(text), "corrected.nc", job.read);
  demand(!verify(job, corrected, false).failure);
  if (is_displaced && every_position_is_known(job.program)) demand_shifted(job.program, corrected);
}

void compensate_and_verify(const Program& program, const ReadOptions& read, bool is_displaced) {
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  const PathForces forces({}, program, path, {Matrix3::Identity()});
  CompensationOptions options;
  options.tolerance = 5e-5;
  options.max_correction = 1e-2;
  static const StartTables starts;
  const Model& model = is_displaced ? displaced() : turned();
  const Job job{model, program, path, forces, options, read, nullptr, &starts};
  const Compensation result = compensate(job, false);
  if (!result.failure) verify_written(job, result.text, is_displaced);
}

}  // namespace
}  // namespace counterflex::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  if (size == 0 || size > fuzz::longest) return 0;
  fuzz::accept_or_refuse([&] {
    const ReadOptions read = fuzz::options_of(data[0]);
    const Program program = read_program(std::string(fuzz::text_of(data + 1, size - 1)), "part.nc", read);
    if (program.text.size() > fuzz::longest_expansion) return;
    for (const bool is_displaced : {true, false}) fuzz::compensate_and_verify(program, read, is_displaced);
  });
  return 0;
}
