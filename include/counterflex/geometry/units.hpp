#pragma once
/// Inside everything is SI (m, rad, N, N m, s); these convert what files and people use. `3 * mm` is 0.003 m,
/// `p / mm` is a length in millimetres.
namespace counterflex {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double mm = 1e-3;
inline constexpr double um = 1e-6;
inline constexpr double inch = 25.4e-3;
inline constexpr double deg = pi / 180.0;
inline constexpr double N_per_um = 1e6;
inline constexpr double N_per_mm = 1e3;
inline constexpr double N_per_mm2 = 1e6;

}  // namespace counterflex
