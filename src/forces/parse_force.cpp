#include <fmt/format.h>

#include "counterflex/files/numbers.hpp"
#include "counterflex/forces/forces.hpp"
#include "forces/csv_text.hpp"

namespace counterflex {

Vector6 parse_force(std::string_view text) {
  const auto fields = csv::split(text);
  if (fields.size() != 3 && fields.size() != 6) {
    throw InputError(
        Exit::usage, {},
        fmt::format("force '{}' has {} numbers, must be FX,FY,FZ or FX,FY,FZ,MX,MY,MZ in N and N m", text,
                    fields.size()));
  }
  Vector6 F = Vector6::Zero();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto value = read_number(fields[i].text);
    if (!value) {
      throw InputError(Exit::usage, {},
                       fmt::format("force '{}': '{}' must be a finite number in {}", text, fields[i].text,
                                   i < 3 ? "N" : "N m"));
    }
    F[static_cast<Eigen::Index>(i)] = *value;
  }
  return F;
}

}  // namespace counterflex
