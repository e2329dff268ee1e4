#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/read_machine.hpp"

int main() {
  const counterflex::Pose X = counterflex::translation({1, 2, 3});
  if ((X * counterflex::inverse(X)).p.norm() > 1e-15) return 1;
  try {
    counterflex::read_machine("format = 'none'", "machine.toml");
  } catch (const counterflex::InputError& error) {
    return error.where().line == 1 ? 0 : 2;
  }
  return 3;
}
