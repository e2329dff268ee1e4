/// The covariance of one fit is the prior of the next one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/report/identification.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

Machine mill_of_fits() {
  return read_machine(machine_file(MachineFacts{}), "mill.toml");
}

/// A session of a tracker about a place, one of another frame about another place, and the truth.
struct Sessions {
  Measurements first, second, both;
};

Sessions sessions_of(const Machine& nominal) {
  Random random(5);
  std::vector<double> values = values_of(nominal);
  const std::vector<Parameter> all = parameters(nominal);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].kind == ParameterKind::orientation) values[i] += 5e-5 * normal(random);
  const Machine truth = with_parameters(nominal, values);
  Sessions result;
  add_tracker(truth, Pose{from_rpy(Vector3(0.3, -0.2, 2)), Vector3(1, -3, 0.4)},
              translation(Vector3(0, 0, 0.08)), false, 30, 0.15, 0, 1e-5, random, result.first, "first");
  add_tracker(truth, Pose{from_rpy(Vector3(0.1, 0.4, -1)), Vector3(2, 1, 0.1)},
              translation(Vector3(0, 0, 0.08)), false, 12, 0.1, 0, 1e-5, random, result.second, "second");
  result.both = result.first;
  result.both.sessions.push_back(result.second.sessions[0]);
  for (Measurement row : result.second.rows) {
    row.session = 1;
    result.both.rows.push_back(row);
  }
  return result;
}

IdentifyOptions geometry_of() {
  IdentifyOptions options;
  options.sets = {ParameterSet::zeros, ParameterSet::geometry};
  options.ladder = false;
  options.hold_out = HoldOut::region;
  return options;
}

/// Largest difference of the fits in deviations, of values and of deviations.
double difference_of(const Identification& a, const Identification& b) {
  double largest = 0;
  REQUIRE(a.parameters.size() == b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const IdentifiedParameter &p = a.parameters[i], &q = b.parameters[i];
    largest = std::max({largest, std::abs(p.value - q.value) / q.sigma, std::abs(p.sigma / q.sigma - 1)});
  }
  return largest;
}

std::string refusal_of_covariance(const std::string& text, const Machine& machine) {
  try {
    read_covariance(text, "first.json", machine);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a fit after a fit, with its covariance, is the fit of all rows") {
  const Machine nominal = mill_of_fits();
  const Sessions sessions = sessions_of(nominal);
  IdentifyOptions options = geometry_of();
  const Identification joint = identify(nominal, sessions.both, options);
  const Identification first = identify(nominal, sessions.first, options);
  const auto second_with = [&](const KnownParameters& prior) {
    options.prior = prior;
    return identify(first.machine, sessions.second, options);
  };
  const KnownParameters prior = read_covariance(to_json(first), "first.json", first.machine);
  const Identification second = second_with(prior);
  CHECK(difference_of(second, joint) < 0.1);
  KnownParameters deviations_alone = prior;
  deviations_alone.covariance = Eigen::MatrixXd(prior.covariance.diagonal().asDiagonal());
  CHECK(difference_of(second_with(deviations_alone), joint) > 0.2);
}

TEST_CASE("a covariance of another machine file is refused, and a matrix that cannot be a covariance") {
  const Machine nominal = mill_of_fits();
  const Identification found = identify(nominal, sessions_of(nominal).first, geometry_of());
  const nlohmann::json whole = nlohmann::json::parse(to_json(found));
  CHECK(refusal_of_covariance(whole.dump(), nominal).starts_with("first.json: error: "));
  CHECK(
      refusal_of_covariance(whole.dump(), nominal).ends_with("use the machine file that the same run wrote"));
  CHECK(refusal_of_covariance("{\"schema\": \"x\"}", nominal) ==
        "first.json: error: the schema is \"x\"; it must be \"counterflex-identification 1\": give the "
        "STEM.json that "
        "identify --report wrote");
  nlohmann::json other = whole;
  other["parameters"][0]["name"] = "no.such_mm";
  CHECK(refusal_of_covariance(other.dump(), found.machine) ==
        "first.json: error: the machine file has no parameter \"no.such_mm\"; use the machine file that the "
        "same run "
        "wrote");
  nlohmann::json indefinite = whole;
  indefinite["covariance"][0][1] = indefinite["covariance"][1][0] =
      2 * whole["parameters"][0]["sigma"].get<double>() * whole["parameters"][1]["sigma"].get<double>();
  CHECK(refusal_of_covariance(indefinite.dump(), found.machine) ==
        "first.json: error: the covariance must be symmetric and positive definite");
  nlohmann::json shorter = whole;
  shorter["covariance"].erase(0);
  CHECK(refusal_of_covariance(shorter.dump(), found.machine) ==
        "first.json: error: the document needs parameters, and a covariance with one row for each of them");
  nlohmann::json missing = whole;
  missing["covariance"][1].erase(1);
  CHECK(refusal_of_covariance(missing.dump(), found.machine) ==
        "first.json: error: the covariance lacks numbers");
}
