#include "process/version.hpp"

namespace counterflex::cli {

const char* const version = COUNTERFLEX_VERSION;

}  // namespace counterflex::cli
