/// Fuzz target for the reader and the rewriter: any bytes are refused with a place or returned unchanged; a
/// shift of every move is written or refused, and never gives an invalid program. A robot program is divided
/// into parts or refused.
#include <string>

#include "counterflex/program/parts.hpp"
#include "counterflex/program/rewrite.hpp"
#include "dialects.hpp"
#include "fuzz.hpp"

namespace counterflex::fuzz {
namespace {

constexpr std::size_t longest = 1 << 14;  // bytes: the time of a run grows with its input
constexpr std::size_t longest_expansion = 250'000;

/// Every move with its end shifted by `shift_mm`.
std::vector<MoveEdit> edits_of(const Program& program, const Vector3& shift_mm) {
  std::vector<MoveEdit> edits;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    MoveEdit edit{.move = i, .end_mm = move.end_mm + shift_mm};
    if (move.arc) edit.centre_mm = move.arc->centre_mm + shift_mm;
    if (move.cycle) {
      edit.bottom_mm = move.cycle->bottom_mm + shift_mm.z();
      edit.retract_mm = move.cycle->retract_mm + shift_mm.z();
    }
    edits.push_back(edit);
  }
  return edits;
}

void rewrite_shifted(const Program& program) {
  try {
    rewrite(program, edits_of(program, {0.125, -0.0625, 0.5}), {});
  } catch (const InputError& error) {
    demand(error.where().line > 0);
  }
}

/// `divide_program` joins the parts again: parts that are not the same as the program are refused.
void divide(const Program& program) {
  constexpr std::size_t most = 3;
  if (!can_be_divided(program.dialect)) return;
  try {
    demand(divide_program("fuzz.nc", program.dialect, program.text, most).size() > 1);
  } catch (const InputError&) {  // refused
  }
}

void read_and_rewrite(const std::string& text, const ReadOptions& options) {
  accept_or_refuse([&] {
    const Program program = read_program(text, "fuzz.nc", options);
    demand(program.text == text || options.expand_subprograms);
    if (program.text.size() > longest_expansion) return;
    demand(rewrite(program, {}, {}).text == program.text);
    demand(rewrite(program, edits_of(program, Vector3::Zero()), {}).text == program.text);
    rewrite_shifted(program);
    divide(program);
  });
}

}  // namespace
}  // namespace counterflex::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex::fuzz;
  if (size == 0 || size > longest) return 0;
  read_and_rewrite(std::string(text_of(data + 1, size - 1)), options_of(data[0]));
  return 0;
}
