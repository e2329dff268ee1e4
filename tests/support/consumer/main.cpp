#include "counterflex/files/numbers.hpp"
#include "counterflex/geometry/pose.hpp"

int main() {
  const counterflex::Pose X = counterflex::translation({1, 2, 3});
  const bool moved = ((X * counterflex::inverse(X)).p.norm() < 1e-15);
  return moved && counterflex::format_fixed(0.0005, 3) == "0.001" ? 0 : 1;
}
