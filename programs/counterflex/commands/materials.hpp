#pragma once
/// Lists the cutting coefficients of known materials.
#include <string>

namespace counterflex::cli {

/// As text, or as JSON.
std::string materials_page(bool json);

}  // namespace counterflex::cli
