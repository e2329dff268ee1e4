#pragma once
/// What is thrown, as a diagnostic and an exit status.
#include <exception>
#include <string>

#include "console.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {

/// What `run` returns; whatever it throws is said through `console`.
template <typename Run>
Exit guarded(Console& console, const Run& run) {
  try {
    return run();
  } catch (const InputError& error) {
    console.error(error.what());
    return error.exit();
  } catch (const std::exception& error) {
    console.error(std::string("error: internal error: ") + error.what());
  } catch (...) {
    console.error("error: internal error");
  }
  return Exit::internal;
}

}  // namespace counterflex::cli
