#include <cstdio>

#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/equilibrium.hpp"

/// Prints the actuator values that move the tip of the loaded, imperfect machine to a wanted pose.
int main(int, char** arguments) {
  using namespace counterflex;
  const Model model = prepare(load_machine(arguments[1]));
  const Pose X_MT = translation({-0.07365, 0, -0.07365});  // m, machine frame
  Load cut;
  cut.F << 215, -10, -25, 1, 21.5, 0;  // N, N m at the tip

  const NominalResult nominal = follow(model, model.home, X_MT);
  if (nominal.status != Status::converged) return 1;
  StaticsWork work(model.mechanism);
  const Equilibrium solved = solve_target(model, nominal.configuration, X_MT, cut, Stage{}, work);
  if (solved.status != Status::converged) return 1;
  for (const double rho : actuator_values(model.mechanism, solved.configuration))
    std::printf("%.6f m\n", rho);
}
