/// Fuzz target for lists of jobs.
#include "counterflex/settings/jobs_file.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  fuzz::accept_or_refuse([&] {
    const JobsFile jobs = read_jobs(fuzz::text_of(data, size), "jobs.toml");
    fuzz::demand(!jobs.jobs.empty() && !jobs.output.empty());
  });
  return 0;
}
