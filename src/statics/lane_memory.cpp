#include "lane_memory.hpp"

namespace counterflex {

LaneMemory::LaneMemory(const LaneModel& model, lanes::Kernel kernel)
    : model_(model), kernel_(kernel), rho_(static_cast<std::size_t>(model.program().actuators) * lanes::width) {
  constexpr long alignment = 64, per_line = alignment / sizeof(double);
  const long lines = lanes::doubles_needed(model.program()) / per_line + 1;
  memory_.reset(static_cast<double*>(std::aligned_alloc(alignment, static_cast<std::size_t>(lines * alignment))));
  batch.rho = rho_.data();
}

std::vector<double> LaneMemory::state(int lane) const {
  std::vector<double> state;
  for (int i = 0; i < model_.program().states; ++i)
    state.push_back(lanes::state_entry(kernel_, model_.program(), memory_.get(), i, lane));
  return state;
}

}  // namespace counterflex
