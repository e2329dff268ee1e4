#include "counterflex/identify/coupon.hpp"

#include <fmt/format.h>

#include "identify/coupon/coupon_half.hpp"

namespace counterflex {
namespace {

constexpr double flattest = 0.1, deepest = 2;  // depth of the box in tool diameters

void refuse_box(const CouponRequest& request) {
  const Vector3 size = request.most_mm - request.least_mm;
  const double D = request.diameter_mm;
  const Place2 half = least_half(D);
  const double x = 2 * half.x, y = half.y;
  if (size.z() > deepest * D)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("--box is {:.4g} mm deep; a tool of {:.4g} mm cuts a coupon of at most {:.4g} mm: "
                    "raise Z0 or take a larger tool",
                    size.z(), D, deepest * D));
  if (size.x() >= x && size.y() >= y && size.z() >= flattest * D) return;
  throw InputError(
      ErrorKind::usage, {},
      fmt::format("--box is {:.4g} x {:.4g} x {:.4g} mm; a coupon for a tool of {:.4g} mm needs at "
                  "least {:.4g} x {:.4g} x {:.4g} mm: take a larger box or a smaller tool",
                  size.x(), size.y(), size.z(), D, x, y, flattest * D));
}

}  // namespace

Coupon make_coupon(const CouponRequest& request) {
  refuse_box(request);
  Coupon coupon;
  coupon.diameter_mm = request.diameter_mm;
  CouponText text(request);
  const double width = (request.most_mm.x() - request.least_mm.x()) / 2;
  text.add(fmt::format("(TEST COUPON, BOX X{:.6g} TO {:.6g} Y{:.6g} TO {:.6g} Z{:.6g} TO {:.6g} MM)",
                       request.least_mm.x(), request.most_mm.x(), request.least_mm.y(), request.most_mm.y(),
                       request.least_mm.z(), request.most_mm.z()));
  text.add(fmt::format("(TOP OF THE STOCK Z{:.6g}, TOOL T{}, END MILL OF {:.4g} MM)", request.most_mm.z(),
                       request.tool, request.diameter_mm));
  text.add("G21 G90 G17 G40 G49 G80 G94");
  text.add("G61");
  text.add("G54");
  text.add(fmt::format("T{} M6", request.tool));
  text.add(fmt::format("G43 H{}", request.tool));
  text.add(fmt::format("S{:.0f} M3", request.speed_rpm));
  text.add(fmt::format("G0 Z{:.4f}", request.most_mm.z() + safe_above_mm));
  text.add("(HALF NOT CORRECTED)");
  add_half(request, request.least_mm.x(), width, false, text, coupon.quantities);
  coupon.first_corrected_line = text.add(std::string(corrected_half));
  add_half(request, request.least_mm.x() + width, width, true, text, coupon.quantities);
  text.add("M5");
  text.add("M30");
  coupon.text = text.take();
  return coupon;
}

}  // namespace counterflex
