#pragma once
/// Text for a stream that may take it later or never: a terminal that was stopped, a connection that hangs.
#include <cstddef>
#include <string>
#include <string_view>

namespace counterflex::cli {

/// Text that is written in order, as soon as the stream takes it without making the writer wait.
class Unsaid {
 public:
  explicit Unsaid(int descriptor);
  ~Unsaid();  ///< what has not been taken by then is lost
  Unsaid(const Unsaid&) = delete;
  Unsaid& operator=(const Unsaid&) = delete;

  /// Writes what the stream takes now and keeps the rest; drops what nobody has taken for a megabyte.
  void add(std::string_view text);

  /// Waits for the stream for that long at most; whether everything has been written.
  bool send(int patience_ms);

  /// Whether nothing is kept and the stream takes something now.
  bool is_clear();

 private:
  bool takes_some(int timeout_ms) const;

  int stream_, own_;  ///< `own_` is a descriptor of the same stream that never waits, or -1
  std::string kept_{};
};

}  // namespace counterflex::cli
