#pragma once
/// Corrects one half of a coupon's program and verifies all of it.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/identify/coupon.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

struct CutCoupon {
  std::string text;                 ///< the program: one half as it was, the other one corrected
  std::vector<CouponPlace> places;  ///< of the cuts of measured surfaces
  Pose X_MW;                        ///< program coordinates in M
};

/// `run` is that of the program of `coupon`. The whole text is read back, matched with the program and solved
/// forward: the one half must not have changed, the other one must be within the tolerance. Otherwise there
/// is a failure, and the result is not to be used.
std::optional<Failure> cut_coupon(const Options& options, Run& run, const Coupon& coupon, Console& console,
                                  CutCoupon& cut);

}  // namespace counterflex::cli
