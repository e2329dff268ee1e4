/// Reading and rewriting program text.
#include <benchmark/benchmark.h>

#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"
#include "made_program.hpp"

namespace counterflex::bench {
namespace {

void read(benchmark::State& state) {
  const std::string text = face_program(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(read_program(text, "face.ngc", {}).moves.size());
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}

/// Every move gets a new end, and every tenth that may a point more.
std::vector<MoveEdit> edits_of(const Program& program) {
  std::vector<MoveEdit> edits;
  const Vector3 shift(0.123, -0.045, 0.067);
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    edits.push_back({.move = i, .end_mm = move.end_mm + shift});
    if (move.arc) edits.back().centre_mm = move.arc->centre_mm + shift;
    if (i % 10 == 0 && move.may_split && !move.arc)
      edits.back().inserted.push_back({(move.start_mm + move.end_mm) / 2 + shift});
  }
  return edits;
}

void write(benchmark::State& state) {
  const Program program = read_program(face_program(static_cast<int>(state.range(0))), "face.ngc", {});
  const std::vector<MoveEdit> edits = edits_of(program);
  for (auto _ : state) benchmark::DoNotOptimize(rewrite(program, edits, {}).text.size());
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * program.text.size()));
}

/// What a run does with text besides solving: every word goes through the reader and the writer.
void read_and_write(benchmark::State& state) {
  const std::string text = mould_program(static_cast<std::size_t>(state.range(0)) << 20);
  const std::vector<MoveEdit> edits = edits_of(read_program(text, "mould.ngc", {}));
  for (auto _ : state) {
    const Program program = read_program(text, "mould.ngc", {});
    benchmark::DoNotOptimize(rewrite(program, edits, {}).text.size());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}

BENCHMARK(read)->Name("text/read")->Arg(1000)->Arg(100000)->Unit(benchmark::kMicrosecond);
BENCHMARK(write)->Name("text/rewrite")->Arg(1000)->Arg(100000)->Unit(benchmark::kMicrosecond);
BENCHMARK(read_and_write)->Name("text/read_and_rewrite_MiB")->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace counterflex::bench
