#pragma once
/// Integration of smooth functions.
#include <array>
#include <cstddef>

namespace counterflex {

/// Positive nodes on [-1, 1] and weights of the 16-point rule; the others are their mirror images. Source:
/// Abramowitz and Stegun, "Handbook of Mathematical Functions", table 25.4.
struct GaussPoint {
  double x = 0;
  double weight = 0;
};
inline constexpr std::array<GaussPoint, 8> gauss_16 = {{{0.0950125098376374402, 0.1894506104550684963},
                                                        {0.2816035507792589132, 0.1826034150449235889},
                                                        {0.4580167776572273863, 0.1691565193950025382},
                                                        {0.6178762444026437484, 0.1495959888165767321},
                                                        {0.7554044083550030339, 0.1246289712555338720},
                                                        {0.8656312023878317439, 0.0951585116824927848},
                                                        {0.9445750230732325761, 0.0622535239386478929},
                                                        {0.9894009349916499326, 0.0271524594117540949}}};

/// int_from^to f(x) dx, exact to rounding for polynomials up to degree 31, and for trigonometric functions
/// over half a turn. `zero` is the value of an empty integral.
template <class Value, class Function>
Value integrate(double from, double to, Value zero, const Function& f) {
  const double middle = (from + to) / 2, half = (to - from) / 2;
  Value sum = zero;
  for (const GaussPoint& point : gauss_16)
    sum += point.weight * half * (f(middle - half * point.x) + f(middle + half * point.x));
  return sum;
}

/// The same for functions that are a broken power of the distance from an end of the interval there, such as
/// sqrt(x) at 0. In each half the points crowd at the end: x = end + t^3 (middle - end).
template <class Value, class Function>
Value integrate_to_weak_ends(double from, double to, Value zero, const Function& f) {
  const double half = (to - from) / 2;
  const auto at = [&](double t) -> Value {
    const double away = half * t * t * t;
    return 3 * half * t * t * (f(from + away) + f(to - away));
  };
  return integrate(0, 1, zero, at);
}

}  // namespace counterflex
