#include "counterflex/compensation/options.hpp"

namespace counterflex {

std::string_view to_string(Method method) {
  switch (method) {
    case Method::direct:
      return "direct";
    case Method::nested:
      return "nested";
    case Method::linear:
      return "linear";
  }
  return "";
}

}  // namespace counterflex
