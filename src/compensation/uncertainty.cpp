#include "counterflex/compensation/uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "compensation/solve/solver.hpp"
#include "counterflex/files/parallel.hpp"
#include "counterflex/machine/parameters.hpp"

namespace counterflex {
namespace {

/// Nothing where the machine does not reach the place.
DatumTangents datum_tangents(const TouchedPlace& touched, const Model& model,
                             const TipUncertainty& uncertainty) {
  const Equilibrium found =
      PlaceSolver(nullptr, false).equilibrium({.model = &model, .target = touched.p_MT});
  if (found.status != Status::converged) return {};
  StaticsWork work = uncertainty.work();
  return uncertainty.of_datum(found.configuration, touched.axes, work);
}

constexpr std::size_t most_places = 64;

/// Independent numbers from the normal distribution.
class Normal {
 public:
  explicit Normal(std::size_t seed) : generator_(seed + 1) {}
  double next() { return distribution_(generator_); }
  Vector3 next3() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> distribution_;
};

Eigen::MatrixXd root(const Eigen::MatrixXd& C) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(C);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// Values of all parameters with those of `known` drawn.
std::vector<double> drawn_values(const std::vector<Parameter>& all, const KnownParameters& known,
                                 const Eigen::MatrixXd& L, Normal& normal) {
  const auto is_scale = [](const Parameter& p) {
    return p.kind == ParameterKind::compliance || p.kind == ParameterKind::mass;
  };
  for (;;) {
    Eigen::VectorXd z(L.cols());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = normal.next();
    const Eigen::VectorXd moved = L * z;
    bool valid = true;
    std::vector<double> values;
    for (const Parameter& parameter : all) {
      const auto at = std::find(known.names.begin(), known.names.end(), parameter.name) - known.names.begin();
      const bool is_known = at < static_cast<std::ptrdiff_t>(known.names.size());
      values.push_back(parameter.value + (is_known ? moved[at] : 0));
      valid = valid && (!is_scale(parameter) || values.back() > 0 || parameter.value == 0);
    }
    if (valid) return values;
  }
}

struct Place {
  const LoadPlace* of = nullptr;
  Pose wanted;
  Vector3 u = Vector3::Zero();
  double band = 0;
};

std::vector<Place> banded_places(const std::vector<LoadPlace>& places) {
  std::vector<const LoadPlace*> known;
  for (const LoadPlace& place : places)
    if (place.at.covariance) known.push_back(&place);
  std::vector<Place> result;
  if (known.empty()) return result;
  PlaceSolver solver(nullptr, known.front()->load.at_platform);
  const std::size_t count = std::min(known.size(), most_places);
  for (std::size_t k = 0; k < count; ++k) {
    const LoadPlace& place = *known[k * known.size() / count];
    const WantedPose wanted = solver.wanted(wanted_at(*place.model, place.at));
    if (wanted.status != Status::converged) continue;
    const Vector3 d = place.at.after.head<3>();
    const Matrix3 C = place.at.covariance->topLeftCorner<3, 3>();
    result.push_back({&place, wanted.X_MT, band_direction(d, C), band(d, C)});
  }
  return result;
}

/// By how much the part of each frame is elsewhere because a drawn machine touched it off.
std::vector<Vector3> drawn_datums(const std::vector<WorkFrame>& frames, const Machine& machine,
                                  double repeatability, Normal& normal) {
  std::vector<Vector3> all(frames.size(), Vector3::Zero());
  const auto is_touched = [](const WorkFrame& frame) { return frame.touched.has_value(); };
  if (std::ranges::none_of(frames, is_touched)) return all;
  const Model drawn = prepare(without_temperature(machine));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const WorkFrame& frame = frames[i];
    if (!is_touched(frame)) continue;
    const UnloadedDeviation touched = unloaded_deviation({&drawn, frame.touched->p_MT});
    if (touched.status != Status::converged) continue;
    all[i] =
        frame.touched->axes.asDiagonal() * (touched.d + repeatability * normal.next3()) - frame.datum_shift;
  }
  return all;
}

/// By place: u'(d - d0) of one sample, where it was solved.
using SampledPlaces = std::vector<std::optional<double>>;

constexpr double solved_to = 1e-11;  // m: rounding errors of positions

/// Compares all samples with the bands of their places.
void compare_with_bands(const std::vector<SampledPlaces>& found, const std::vector<Place>& at,
                        SampledBands& bands) {
  std::size_t inside = 0, count = 0;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < at.size(); ++i) {
    double sum = 0, squares = 0;
    std::size_t solved = 0;
    for (const SampledPlaces& sample : found) {
      if (!sample[i]) continue;
      sum += *sample[i];
      squares += *sample[i] * *sample[i];
      ++solved;
      if (std::abs(*sample[i]) <= at[i].band + solved_to) ++inside;
    }
    count += solved;
    if (solved < 2 || at[i].band == 0) continue;
    const double n = static_cast<double>(solved), mean = sum / n;
    ratios.push_back(2 * std::sqrt(std::max(squares / n - mean * mean, 0.0)) / at[i].band);
  }
  bands.unsolved = found.size() * at.size() - count;
  if (count > 0) bands.covered_percent = 100.0 * static_cast<double>(inside) / static_cast<double>(count);
  if (ratios.empty()) return;
  bands.least_ratio = *std::ranges::min_element(ratios);
  bands.largest_ratio = *std::ranges::max_element(ratios);
}

}  // namespace

TipUncertainties tip_uncertainties(const Machine& machine, const Model& model, const ToolModels& tools,
                                   const std::vector<WorkFrame>& frames) {
  TipUncertainties all;
  if (!machine.uncertainty) return all;
  const TipUncertainty& own = all.by_model.emplace(&model, TipUncertainty(machine, model)).first->second;
  for (const auto& [number, with] : tools)
    all.by_model.emplace(&with, TipUncertainty(machine, with, &machine.tools.at(number)));
  for (const WorkFrame& frame : frames)
    all.by_frame.push_back(frame.touched ? datum_tangents(*frame.touched, model, own) : DatumTangents{});
  return all;
}

DrawnMachine drawn_machine(const Machine& machine, std::size_t index) {
  const Uncertainty& uncertainty = *machine.uncertainty;
  Normal normal(index);
  DrawnMachine drawn{machine};
  drawn.force = 1 + uncertainty.force * normal.next();
  drawn.tool_length = uncertainty.tool_length * normal.next();
  const double warmer = uncertainty.temperature * normal.next();
  const KnownParameters known = uncertain_parameters(machine);
  if (!known.names.empty())
    drawn.machine =
        with_parameters(machine, drawn_values(parameters(machine), known, root(known.covariance), normal));
  if (warmer != 0) {
    const std::vector<double>& range = machine.thermal->temperatures;
    drawn.machine =
        at_temperature(drawn.machine, std::clamp(*machine.temperature + warmer, range.front(), range.back()));
  }
  return drawn;
}

SampledBands sample_bands(const Machine& machine, const std::vector<long>& tools,
                          const std::vector<WorkFrame>& frames, const std::vector<LoadPlace>& places,
                          std::size_t samples, int threads) {
  const std::vector<Place> at = banded_places(places);
  SampledBands bands{samples, at.size()};
  std::vector<SampledPlaces> found(samples);
  for_each_index(samples, threads, [&](std::size_t k) {
    const DrawnMachine drawn = drawn_machine(machine, k);
    const Model model = prepare(drawn.machine);
    const ToolModels with = prepare_tools(drawn.machine, model, tools);
    PlaceSolver solver(nullptr, !at.empty() && at.front().of->load.at_platform);
    Normal normal(~k);
    const std::vector<Vector3> datums =
        drawn_datums(frames, drawn.machine, machine.uncertainty->repeatability, normal);
    for (const Place& place : at) {
      ForwardRequest request = request_at(*place.of);
      request.model = &model_with(model, &with, place.of->tool);
      request.F *= drawn.force;
      const ForwardAnswer answer = solver.forward(request);
      const Vector3 own =
          machine.uncertainty->repeatability * normal.next3() - drawn.tool_length * answer.X_MT.R.col(2);
      std::optional<double>& result = found[k].emplace_back();
      if (answer.status == Status::converged)
        result = place.u.dot(deviation(answer.X_MT, place.wanted).head<3>() + own - datums[place.of->frame] -
                             place.of->at.after.head<3>());
    }
  });
  compare_with_bands(found, at, bands);
  return bands;
}

std::optional<TipCovariance> solve_covariance(const LoadPlace& place, const TipUncertainties& uncertainties,
                                              const StartTables* starts) {
  const Equilibrium found = PlaceSolver(starts, place.load.at_platform).equilibrium(request_at(place));
  if (found.status != Status::converged) return std::nullopt;
  const TipUncertainty& uncertainty = uncertainties.by_model.at(place.model);
  StaticsWork work = uncertainty.work();
  return uncertainty.of_tip(found.configuration, place.load, work, uncertainties.by_frame[place.frame]);
}

}  // namespace counterflex
