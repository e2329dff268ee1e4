#pragma once
/// The features of one half of a coupon.
#include <vector>

#include "identify/coupon/coupon_text.hpp"

namespace counterflex {

/// The least size of a half in x and y (mm).
Place2 least_half(double diameter_mm);

/// Adds the blocks that cut all features from `least_x` to `least_x + width`, and the quantities that can be
/// measured there.
void add_half(const CouponRequest& request, double least_x, double width, bool is_corrected, CouponText& text,
              std::vector<CouponQuantity>& quantities);

}  // namespace counterflex
