#include "counterflex/statics/travel.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "counterflex/sanity/path_checks.hpp"
#include "counterflex/statics/tool_models.hpp"

namespace counterflex {
namespace {

// A first-order value is used as far from the last exact one as it was right before. On machines of linear
// axes it is right everywhere, on arms for some centimetres.
constexpr double right = 1e-6, wrong = 1e-4;  // m and rad
constexpr double least_reach = 1 * mm, first_reach = 10 * mm, most_reach = 100;

}  // namespace

/// Actuator values along the path of one model after another.
struct TravelTally::Follower {
  explicit Follower(const Model& first) : path(home_of(first)) {}

  /// Actuator values at `target` and whether they are exact; none where the target is not reached.
  struct Values {
    Eigen::VectorXd rho;
    bool exact = true;
  };
  std::optional<Values> go_to(const Model& m, const Vector3& target) {
    const bool known = model == &m && inverse.cols() == 3;
    const Vector3 step = target - p;
    if (known && step.norm() <= reach) return Values{rho + inverse * step, false};
    if (path.go_to(m, target) != Status::converged) return std::nullopt;
    const Eigen::VectorXd exact = actuator_values(m.mechanism, path.configuration());
    if (known) adapt((rho + inverse * step - exact).cwiseAbs().maxCoeff(), step.norm());
    model = &m;
    p = target;
    rho = exact;
    measure();
    return Values{exact, true};
  }

  void adapt(double error, double distance) {
    if (error < right) reach = std::min(std::max(reach, 2 * distance), most_reach);
    if (error > wrong) reach = std::max(std::min(reach, distance) / 2, least_reach);
  }

  /// d rho / d p of the tip, where its position is controlled and as many components as actuators are.
  void measure() {
    inverse.resize(0, 0);
    const auto& controlled = model->mechanism.controlled;
    const Eigen::MatrixXd J = actuator_jacobian(*model, path.configuration()).J;
    if (J.rows() != J.cols() || controlled.size() < 3 || controlled[2] != Component::z) return;
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(J);
    if (lu.isInvertible()) inverse = lu.inverse().leftCols<3>();
  }

  NominalToolPath path;
  const Model* model = nullptr;
  Vector3 p = Vector3::Zero();
  Eigen::VectorXd rho;
  Eigen::MatrixXd inverse;
  double reach = first_reach;

  struct Tightest {
    AxisPlace at;
    bool exact = true;
    const Model* model = nullptr;
    Vector3 target = Vector3::Zero();
    int line = 0;
    double share = 0;
  };
  std::optional<Tightest> tightest;
};

TravelTally::TravelTally() = default;
TravelTally::~TravelTally() = default;
TravelTally::TravelTally(TravelTally&&) noexcept = default;
TravelTally& TravelTally::operator=(TravelTally&&) noexcept = default;

void TravelTally::add(const Model& model, const Waypoint& w) {
  if (w.status != Status::converged || w.segment == no_segment) return;
  add(model, w.p_MT + w.correction.head<3>(), w.line);
}

void TravelTally::add(const Model& model, const Vector3& target, int line) {
  if (model.mechanism.controlled.empty()) return;
  if (!follower_) follower_ = std::make_unique<Follower>(model);
  const auto values = follower_->go_to(model, target);
  if (!values) return;
  ++places_;
  const auto at = tightest_axis(model.mechanism, values->rho);
  if (!at) return;
  auto& tightest = follower_->tightest;
  if (tightest && at->share >= tightest->share - 1e-9) return;  // the first but for rounding
  tightest = Follower::Tightest{*at, values->exact, &model, target, line, at->share};
}

std::optional<LeastMargin> TravelTally::least() const {
  if (!follower_ || !follower_->tightest) return std::nullopt;
  const Follower::Tightest& tightest = *follower_->tightest;
  AxisPlace at = tightest.at;
  if (!tightest.exact) {
    NominalToolPath path(home_of(*tightest.model));
    if (path.go_to(*tightest.model, tightest.target) == Status::converged)
      at = *tightest_axis(tightest.model->mechanism,
                          actuator_values(tightest.model->mechanism, path.configuration()));
  }
  return LeastMargin{at.actuator, at.value, at.margin, tightest.line};
}

SanityCheck check_travel(const Mechanism& named, const TravelTally& tally, const std::optional<Failure>& failure) {
  if (failure && failure->status == Status::outside_travel)
    return {"travel", SanityState::doubtful, fmt::format("line {}: {}", failure->line, failure->what)};
  if (failure)
    return {"travel", SanityState::unknown,
            failure->line > 0 ? fmt::format("not known behind line {}, where the run ended", failure->line)
                              : "not known, since the run ended"};
  const auto least = tally.least();
  if (!least)
    return {"travel", SanityState::unknown,
            tally.places() == 0 ? "no place of the path was solved"
                                : "no actuator has a travel in the machine file"};
  const Travel& travel = named.travel[least->actuator];
  if (least->margin < 0)
    return {"travel", SanityState::doubtful,
            fmt::format("line {}: {}", least->line, outside_travel_words(travel, least->value))};
  return {"travel", SanityState::ok,
          fmt::format("least margin {} on {}: {} at line {}, travel {}", axis_value(travel, least->margin),
                      travel.name, axis_value(travel, least->value), least->line, travel_range(travel))};
}

}  // namespace counterflex
