#pragma once

namespace counterflex::cli {

extern const char* const version;

}  // namespace counterflex::cli
