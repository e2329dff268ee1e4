#pragma once
/// How coordinates are written.
#include <string>
#include <string_view>

namespace counterflex {

/// `value` in the style of the number `original`: its sign style ("+1"), its leading zero or none (".5"), its
/// decimals or as many more, up to `decimals`, as the value needs; always with a point.
std::string changed_number(std::string_view original, double value, int decimals);

/// `value` with `decimals` digits after the point, which it always has.
std::string inserted_number(double value, int decimals);

/// Whether `wanted` is within half a unit of the last of `decimals` digits of `original`, so that writing it
/// anew would be no more exact; also where they differ by no more than arithmetic does, 1e-10.
bool rounds_to(double original, double wanted, int decimals);

/// 10 to the power of `digits`, from 0 to 9 at least.
double power_of_ten(int digits);

}  // namespace counterflex
