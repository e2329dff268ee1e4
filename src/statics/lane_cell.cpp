#include "lane_cell.hpp"

#include "lane_polynomial.hpp"

namespace counterflex {
namespace {

constexpr int displacement_degree = 3;
static_assert(displacement_degree <= lanes::most_displacement_degree);

void put_unloaded(const Vector3& p, int lane, lanes::Batch& batch) { put_in_lane(p, Vector6::Zero(), lane, batch); }

}  // namespace

lanes::Region LaneCell::flat() const {
  lanes::Region region = zone_->flat();
  start_.enter(region);
  region.tangents = tangents_.numbers.data();
  region.bend = bend_.data();
  region.straighten = tangents_.straighten.data();
  for (int i = 0; i < 3; ++i) region.place[i] = centre_[i];
  region.kinematic = nullptr;
  return region;
}

bool LaneCell::take_tangents(const Model& model, StaticsWork& work) {
  LaneMemory memory(lane_model_);
  for (int lane = 0; lane < lanes::width; ++lane) put_unloaded(centre_, lane, memory.batch);
  memory.solve(zone_->flat(), {.target = false, .kinematics = false, .acting = lanes::everything, .go_on = false});
  if (!memory.batch.converged[0]) return false;
  start_ = LaneStart(memory.state(0));
  bend_ = zone_->bend_of_actuators(centre_);
  const Configuration reference = lane_model_.configuration_of(start_.state().data(), zone_->reference());
  return tangents_.take(model, lane_model_, reference, zone_->actuators_by_position(centre_), work);
}

std::unique_ptr<LaneCell> LaneCell::make(const Model& model, const LaneModel& lane_model, std::shared_ptr<const LaneZone> zone,
                                         const Vector3& centre, double half, StaticsWork& work) {
  std::unique_ptr<LaneCell> cell(new LaneCell(lane_model, std::move(zone), centre, half));
  if (!cell->take_tangents(model, work)) return nullptr;
  return cell;
}

// Fitted to what lanes find from the centre; empty where they do not.
std::vector<double> LaneCell::displacement(lanes::Acting acting) const {
  const PolynomialFit& fit = polynomial_fit(displacement_degree);
  const auto count = static_cast<Eigen::Index>(fit.points.size());
  const Eigen::Index rows = lane_model_.program().rows + 6;
  Eigen::MatrixXd steps(rows, count);
  LaneMemory memory(lane_model_);
  for (Eigen::Index first = 0; first < count; first += lanes::width) {
    for (int lane = 0; lane < lanes::width; ++lane)
      put_unloaded(centre_ + half_ * fit.points[static_cast<std::size_t>(std::min(first + lane, count - 1))], lane, memory.batch);
    memory.solve(flat(), {.target = false, .kinematics = false, .acting = acting, .go_on = false});
    for (int lane = 0; lane < lanes::width && first + lane < count; ++lane) {
      if (!memory.batch.converged[lane]) return {};
      const std::vector<double> step = lane_model_.step_between(start_.state(), memory.state(lane));
      steps.col(first + lane) = Eigen::VectorXd::Map(step.data(), rows);
    }
  }
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> all = steps * fit.from_values.transpose();
  return {all.data(), all.data() + all.size()};
}

lanes::Region LaneCell::region(lanes::Acting acting) const {
  const auto which = 2 * static_cast<std::size_t>(acting.errors) + static_cast<std::size_t>(acting.weights);
  std::call_once(asked_[which], [&] { displacements_[which] = displacement(acting); });
  lanes::Region region = flat();
  if (displacements_[which].empty()) return region;
  region.displacement = displacements_[which].data();
  region.displacement_degree = displacement_degree;
  for (int i = 0; i < 3; ++i) region.displacement_centre[i] = centre_[i];
  region.displacement_half = half_;
  return region;
}

}  // namespace counterflex
