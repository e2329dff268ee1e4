#pragma once
/// Turns exceptions into diagnostics and kinds of errors.
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

/// Returns the result of `run`, which is made of a kind of error or of nothing. If `run` throws, reports the
/// exception through `console` and returns its kind. Lack of memory or threads may be temporary.
template <typename Run>
auto guarded(Console& console, const Run& run) {
  using Result = decltype(run());
  try {
    return run();
  } catch (const InputError& error) {
    console.error(error.what());
    return Result(error.kind());
  } catch (const std::bad_alloc&) {
    console.error("error: there is not enough memory");
    return Result(ErrorKind::transient_io);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) {
      console.error("error: the system has no more threads");
      return Result(ErrorKind::transient_io);
    }
    console.error(std::string("error: internal error: ") + error.what());
  } catch (const std::exception& error) {
    console.error(std::string("error: internal error: ") + error.what());
  } catch (...) {
    console.error("error: internal error");
  }
  return Result(ErrorKind::internal);
}

}  // namespace counterflex::cli
