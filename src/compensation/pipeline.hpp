#pragma once
/// Items that go through stages, several at once, on a fixed number of threads.
#include <cstddef>
#include <functional>
#include <vector>

namespace counterflex {

/// A stage works on the item in `slot`. Items come to a stage in their order where it is `in_order`, and one
/// at a time; else any number of them at once. `threads` is how many threads the work may use.
struct PipelineStage {
  bool in_order = false;
  std::function<void(std::size_t slot, int threads)> work;
};

/// Takes items through `stages`. `begin` makes the next item in a free slot, in
/// order; false: there are no more. The last stage comes in order and says when to stop: items behind that
/// one are given up wherever they are. Slots are numbered from 0 to `slots` - 1; no item begins before the
/// one that had its slot has left the last stage. What an item becomes depends on its stages alone, never on
/// `threads`; with one thread everything runs in the calling one. What `begin` or a stage throws ends all and
/// is thrown on, the first of it: work whose failures have an order keeps them for the last stage.
void run_pipeline(const std::function<bool(std::size_t slot)>& begin,
                  const std::vector<PipelineStage>& stages, const std::function<bool(std::size_t slot)>& end,
                  std::size_t slots, int threads);

}  // namespace counterflex
