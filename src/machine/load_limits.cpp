#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex {

const LoadName& name_of(LoadKind kind) {
  static constexpr std::array<LoadName, load_kind_count> names = {{
      {"moment_max_Nm", "moment at the end", "N m", 1},
      {"spring_translation_max_mm", "spring deflection", "mm", mm},
      {"spring_rotation_max_deg", "spring rotation", "deg", deg},
      {"spring_force_max_N", "spring force", "N", 1},
      {"spring_torque_max_Nm", "spring torque", "N m", 1},
      {"group_moment_max_Nm", "group moment", "N m", 1},
      {"passive_change_max_deg", "passive joint's change", "deg", deg},
  }};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace counterflex
