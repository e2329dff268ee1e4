#include "lane_memory.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {

namespace {

double* aligned_doubles(long count) {
  constexpr long alignment = 64, per_line = alignment / sizeof(double);
  return static_cast<double*>(std::aligned_alloc(alignment, static_cast<std::size_t>((count / per_line + 1) * alignment)));
}

}  // namespace

LaneMemory::LaneMemory(const LaneModel& model, lanes::Kernel kernel)
    : model_(model), kernel_(kernel), rho_(static_cast<std::size_t>(model.program().actuators) * lanes::width) {
  memory_.reset(aligned_doubles(lanes::doubles_needed(model.program())));
  batch.rho = rho_.data();
}

std::array<bool, lanes::width> LaneMemory::stable(const lanes::Region& region, const lanes::Question& question) {
  if (!scratch_) scratch_.reset(aligned_doubles(lanes::doubles_of_certificate(model_.program())));
  std::array<bool, lanes::width> yes{};
  kernel_.judge(model_.program(), region, question, batch, memory_.get(), scratch_.get(), yes.data());
  return yes;
}

double LaneMemory::largest_wrench(int lane) const {
  const lanes::Program& program = model_.program();
  double largest = 0;
  for (int s = 0; s < program.series_count; ++s)
    for (int i = 0; i < 6; ++i)
      largest = std::max(largest, std::abs(lanes::state_entry(kernel_, program, memory_.get(), program.series[s].wrench + i, lane)));
  return largest;
}

std::vector<double> LaneMemory::state(int lane) const {
  std::vector<double> state;
  for (int i = 0; i < model_.program().states; ++i)
    state.push_back(lanes::state_entry(kernel_, model_.program(), memory_.get(), i, lane));
  std::fill(state.begin() + model_.program().standing, state.end(), 0.0);
  return state;
}

}  // namespace counterflex
