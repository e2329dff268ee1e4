#include "counterflex/statics/nominal.hpp"

namespace counterflex {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::not_converged:
      return "not_converged";
    case Status::unreachable:
      return "unreachable";
    case Status::singular:
      return "singular";
    case Status::unstable:
      return "unstable";
    case Status::outside_travel:
      return "outside_travel";
  }
  return "not_converged";
}

}  // namespace counterflex
