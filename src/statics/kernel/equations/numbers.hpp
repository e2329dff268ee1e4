#pragma once
/// The kernel's numbers: double, or vectors of doubles with a waypoint in each lane. Operations on vectors
/// are those on doubles, lane by lane, so that a lane has the bits that the scalar instance has: the kernel
/// is compiled without contraction of products and sums.
#include <cmath>

namespace counterflex::kernel {

#define COUNTERFLEX_INLINE inline __attribute__((always_inline))
#define COUNTERFLEX_UNROLL _Pragma("GCC unroll 36")

typedef double Lanes4 __attribute__((vector_size(32)));
typedef double Lanes8 __attribute__((vector_size(64)));

template <class T>
struct LaneTraits {
  static constexpr int count = sizeof(T) / sizeof(double);
  typedef long long Mask __attribute__((vector_size(sizeof(T))));
};
template <>
struct LaneTraits<double> {
  static constexpr int count = 1;
  using Mask = bool;
};
template <class T>
using Mask = typename LaneTraits<T>::Mask;
template <class T>
inline constexpr int lane_count = LaneTraits<T>::count;

template <class T>
COUNTERFLEX_INLINE T all(double value) {
  return value - T{};  // not a sum: it would change -0
}
template <class T>
COUNTERFLEX_INLINE T select(Mask<T> where, T yes, T no) {
  return where ? yes : no;
}
template <class T>
COUNTERFLEX_INLINE T larger(T a, T b) {
  return a > b ? a : b;
}
template <class T>
COUNTERFLEX_INLINE T smaller(T a, T b) {
  return a < b ? a : b;
}
template <class T>
COUNTERFLEX_INLINE T magnitude(T a) {
  return larger(a, -a);
}

template <class T>
COUNTERFLEX_INLINE double& lane(T& x, int i) {
  return reinterpret_cast<double*>(&x)[i];
}
template <class T>
COUNTERFLEX_INLINE double lane(const T& x, int i) {
  return reinterpret_cast<const double*>(&x)[i];
}
template <class T>
COUNTERFLEX_INLINE bool lane_of_mask(const Mask<T>& mask, int i) {
  if constexpr (lane_count<T> == 1)
    return mask;
  else
    return mask[i] != 0;
}
template <class T>
COUNTERFLEX_INLINE Mask<T> opposite(const Mask<T>& mask) {
  if constexpr (lane_count<T> == 1)
    return !mask;
  else
    return ~mask;
}
template <class T>
COUNTERFLEX_INLINE bool any(const Mask<T>& mask) {
  if constexpr (lane_count<T> == 1) {
    return mask;
  } else {
    long long bits = 0;
    for (int i = 0; i < lane_count<T>; ++i) bits |= mask[i];
    return bits != 0;
  }
}

/// `value(i)` in lane i.
template <class T, class Value>
COUNTERFLEX_INLINE T gather(const Value& value) {
  T result{};
  for (int i = 0; i < lane_count<T>; ++i) lane(result, i) = value(i);
  return result;
}

/// The lanes i of which `is(i)` is true.
template <class T, class Is>
COUNTERFLEX_INLINE Mask<T> lanes_where(const Is& is) {
  if constexpr (lane_count<T> == 1) {
    return is(0);
  } else {
    Mask<T> mask{};
    for (int i = 0; i < lane_count<T>; ++i) mask[i] = is(i) ? -1 : 0;
    return mask;
  }
}

}  // namespace counterflex::kernel
