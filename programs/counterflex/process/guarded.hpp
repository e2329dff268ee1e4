#pragma once
/// What is thrown, as a diagnostic and an exit status.
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

/// What `run` returns; whatever it throws is said through `console`. Memory, or threads, that there are not
/// enough of now may be there another time.
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
