#include "process/terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace counterflex::cli {

std::vector<const char*> begin_process(int argc, char** argv) {
  return {argv, argv + argc};
}

const char* const* environment_variables() {
  return environ;
}

bool is_terminal(int descriptor) {
  return ::isatty(descriptor) == 1;
}

bool has_colours(int descriptor) {
  const char* terminal = std::getenv("TERM");
  return is_terminal(descriptor) && terminal != nullptr && std::string_view(terminal) != "dumb";
}

/// By the locale in the first of these variables that is set.
bool shows_utf8(int descriptor) {
  if (!is_terminal(descriptor)) return false;
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view locale(value);
    return locale.find("UTF-8") != std::string_view::npos || locale.find("utf8") != std::string_view::npos;
  }
  return false;
}

bool is_ready(int descriptor) {
  pollfd stream{descriptor, POLLOUT, 0};
  return ::poll(&stream, 1, 0) > 0 && (stream.revents & POLLOUT) != 0;
}

std::size_t columns_of(int descriptor) {
  winsize window{};
  return ::ioctl(descriptor, TIOCGWINSZ, &window) == 0 ? window.ws_col : 0;
}

}  // namespace counterflex::cli
