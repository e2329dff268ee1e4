#include "counterflex/sanity/checks.hpp"

namespace counterflex {

std::string_view to_string(SanityState state) {
  switch (state) {
    case SanityState::ok:
      return "ok";
    case SanityState::doubtful:
      return "doubtful";
    case SanityState::wrong:
      return "wrong";
    case SanityState::unknown:
      return "unknown";
  }
  return "";
}

}  // namespace counterflex
