#include <cerrno>
#include <string>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "files/descriptor.hpp"

namespace counterflex {
namespace {

[[noreturn]] void fail_keeping() {
  throw InputError(ErrorKind::transient_io, {},
                   "cannot keep a text in a temporary file: " + system::reason_of(errno));
}

}  // namespace

Spool::~Spool() {
  if (fd_ >= 0) ::close(fd_);
}

void Spool::append(std::string_view bytes) {
  if (fd_ < 0) fd_ = system::make_nameless_file();
  if (fd_ < 0 || !system::append(fd_, bytes)) fail_keeping();
}

void Spool::read(std::size_t offset, char* to, std::size_t count) const {
  while (count > 0) {
    const std::ptrdiff_t n = system::read_at(fd_, to, count, offset);
    if (n <= 0) fail_keeping();
    to += n;
    offset += static_cast<std::size_t>(n);
    count -= static_cast<std::size_t>(n);
  }
}

}  // namespace counterflex
