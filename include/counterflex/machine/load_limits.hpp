#pragma once
/// What joints, springs and ends of chains may bear, as a machine file says it, and what the kinds of load
/// are called.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace counterflex {

/// Of one chain; largest absolute components, as `ChainLoads` has them.
enum class LoadKind : std::uint8_t {
  moment,              ///< that the platform exerts on the chain's end
  spring_translation,  ///< of springs and prismatic compliances
  spring_rotation,     ///< of springs and revolute compliances
  spring_force,
  spring_torque,
  group_moment,    ///< that branches side by side transmit at their common end
  passive_change,  ///< of a revolute passive joint's angle from its nominal value
};
inline constexpr std::size_t load_kind_count = static_cast<std::size_t>(LoadKind::passive_change) + 1;
inline constexpr std::array<LoadKind, load_kind_count> load_kinds = {
    LoadKind::moment,        LoadKind::spring_translation, LoadKind::spring_rotation, LoadKind::spring_force,
    LoadKind::spring_torque, LoadKind::group_moment,       LoadKind::passive_change};

/// How files and people name a kind of load.
struct LoadName {
  std::string_view key;    ///< "moment_max_Nm": in machine files and JSON documents
  std::string_view words;  ///< "moment at the end"
  std::string_view unit;   ///< of the key's values: "N m"
  double si = 1;           ///< that unit in SI
};
const LoadName& name_of(LoadKind kind);

/// SI, positive; none: no limit is known.
struct LoadLimits {
  std::array<std::optional<double>, load_kind_count> most{};

  std::optional<double>& operator[](LoadKind kind) { return most[static_cast<std::size_t>(kind)]; }
  const std::optional<double>& operator[](LoadKind kind) const {
    return most[static_cast<std::size_t>(kind)];
  }
  bool operator==(const LoadLimits&) const = default;
};

}  // namespace counterflex
