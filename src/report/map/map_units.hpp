#pragma once
/// Units and names of the quantities of a map.
#include <string>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/map.hpp"

namespace counterflex {

/// How the values of a map are shown.
struct MapUnit {
  const char* name;    ///< "N/um"
  const char* column;  ///< "stiffness_N_per_um"
  double si;
};

inline MapUnit unit_of(MapQuantity quantity) {
  return quantity == MapQuantity::stiffness ? MapUnit{"N/um", "stiffness_N_per_um", N_per_um}
                                            : MapUnit{"um", "deviation_um", um};
}

/// The status of a place in tables: also "rigid".
std::string status_text(const MapPlace& place);

/// "least stiffness of the tip".
std::string quantity_text(const MapRequest& request);

/// "load (0, 0, -200) N, (0, 0, 0) N m at the tool tip, machine axes", weights included; empty if neither
/// acts.
std::string load_text(const WorkspaceMap& map);

/// "x 0 to 400, y 0 to 250, z -440 to -140 mm".
std::string box_text(const MapBox& box);

/// "200, 100, -200", in mm.
std::string mm_text(const Vector3& p);

/// A value in its unit, four digits; of a stiffness below 0.01 N/um three significant ones.
std::string value_text(double value, MapQuantity quantity);

}  // namespace counterflex
