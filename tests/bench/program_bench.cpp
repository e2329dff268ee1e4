/// Reading and rewriting program text: the work of a run on every word besides solving.
#include <benchmark/benchmark.h>

#include "counterflex/program/program_reader.hpp"
#include "counterflex/program/rewrite.hpp"
#include "made_program.hpp"

namespace counterflex::bench {
namespace {

constexpr std::size_t megabytes = 8'000'000;

struct Text {
  std::string name;
  std::string (*make)(std::size_t bytes);
};

/// Every move to its place plus `shift`, and every tenth that may with a point more where `points`.
std::vector<MoveEdit> edits_of(const Program& program, const Vector3& shift, bool points = false) {
  std::vector<MoveEdit> edits;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    edits.push_back({.move = i, .end_mm = move.end_mm + shift});
    if (move.arc) edits.back().centre_mm = move.arc->centre_mm + shift;
    if (points && i % 10 == 0 && move.may_split && !move.arc)
      edits.back().inserted.push_back({(move.start_mm + move.end_mm) / 2 + shift});
  }
  return edits;
}

void count_bytes(benchmark::State& state, const std::string& text) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}

/// Reads `text` as a run does, window by window; `take` gets each.
template <typename Take>
void read_windows(const std::string& text, const Take& take) {
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "made.ngc", {});
  while (reader.next()) take(reader.window());
}

void read_only(benchmark::State& state, const Text& made) {
  const std::string text = made.make(megabytes);
  for (auto _ : state) {
    std::size_t moves = 0;
    read_windows(text, [&](const Program& window) { moves += window.moves.size(); });
    benchmark::DoNotOptimize(moves);
  }
  count_bytes(state, text);
}

/// `make_edits` is not timed: it belongs to solving.
template <typename MakeEdits>
void read_and_rewrite(benchmark::State& state, const Text& made, const MakeEdits& make_edits) {
  const std::string text = made.make(megabytes);
  std::vector<std::vector<MoveEdit>> edits;
  read_windows(text, [&](const Program& window) { edits.push_back(make_edits(window)); });
  for (auto _ : state) {
    Rewriter rewriter({});
    std::size_t next = 0, bytes = 0;
    read_windows(text,
                 [&](const Program& window) { bytes += rewriter.write(window, edits[next++]).text.size(); });
    benchmark::DoNotOptimize(bytes);
  }
  count_bytes(state, text);
}

const Vector3 small_shift(0.123, -0.045, 0.067);

void copy(benchmark::State& state, const Text& made) {
  read_and_rewrite(state, made, [](const Program&) { return std::vector<MoveEdit>(); });
}

void rewrite_same(benchmark::State& state, const Text& made) {
  read_and_rewrite(state, made, [](const Program& window) { return edits_of(window, Vector3::Zero()); });
}

void rewrite_shifted(benchmark::State& state, const Text& made) {
  read_and_rewrite(state, made, [](const Program& window) { return edits_of(window, small_shift); });
}

void rewrite_with_points(benchmark::State& state, const Text& made) {
  read_and_rewrite(state, made, [](const Program& window) { return edits_of(window, small_shift, true); });
}

[[maybe_unused]] const int registered_texts = [] {
  for (const Text& text :
       {Text{"numbered", numbered_program}, Text{"terse", mould_program}, Text{"arcs", arc_program}}) {
    const auto add = [&](const char* what, void (*run)(benchmark::State&, const Text&)) {
      benchmark::RegisterBenchmark(("text/" + text.name + "/" + what).c_str(), run, text)
          ->Unit(benchmark::kMillisecond);
    };
    add("read", read_only);
    add("read+copy", copy);
    add("read+rewrite_same", rewrite_same);
    add("read+rewrite_shifted", rewrite_shifted);
    add("read+rewrite_points", rewrite_with_points);
  }
  return 0;
}();

}  // namespace
}  // namespace counterflex::bench
