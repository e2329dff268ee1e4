#pragma once
/// Diagnostics and exit statuses of what is thrown.
#include <exception>
#include <string>

#include "console.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {

/// Turns whatever `run` throws into a diagnostic and an exit status.
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
