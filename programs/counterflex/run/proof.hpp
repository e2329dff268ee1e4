#pragma once
/// The setup sheet of --proof.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/program/restart.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Whether the run writes a setup sheet.
bool wants_proof(const Options& options);

/// Gathers what the sheet needs of the corrected program.
class ProofNotes {
 public:
  explicit ProofNotes(const std::string& dialect) : restart_(dialect) {}

  /// The next whole lines of the corrected program.
  void add_text(std::string_view lines) { restart_.add(lines); }

  /// The next waypoints of it, solved forward.
  void add(const Job& window, const std::vector<Waypoint>& waypoints);

  /// Lets `events` add the waypoints of each window here, too. This must outlive `events`.
  void listen(WindowEvents& events);

  /// The facts of the sheet but the hashes of the written files. Solves the window of the work offsets: call
  /// it before the start tables of `run` are freed.
  ProofFacts facts(const Run& run);

 private:
  LoadPlaces places_{KeptPlace::largest_rest};
  RestartScan restart_;
  std::size_t solved_ = 0;
};

}  // namespace counterflex::cli
