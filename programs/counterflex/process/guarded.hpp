#pragma once
/// Turns exceptions into diagnostics and exit statuses.
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

/// Returns the result of `run`, or reports its exception through `console`. Lack of memory or threads may be
/// temporary.
template <typename Run>
Exit guarded(Console& console, const Run& run) {
  try {
    return run();
  } catch (const InputError& error) {
    console.error(error.what());
    return error.exit();
  } catch (const std::bad_alloc&) {
    console.error("error: there is not enough memory");
    return Exit::transient_io;
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) {
      console.error("error: the system has no more threads");
      return Exit::transient_io;
    }
    console.error(std::string("error: internal error: ") + error.what());
  } catch (const std::exception& error) {
    console.error(std::string("error: internal error: ") + error.what());
  } catch (...) {
    console.error("error: internal error");
  }
  return Exit::internal;
}

}  // namespace counterflex::cli
