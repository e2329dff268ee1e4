/// Fuzz target for `compare`: any bytes as a report are refused as wrong usage, or compared with themselves.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "counterflex/report/comparison.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  static const int file = memfd_create("report", 0);  // reports are read from files
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  fuzz::demand(file >= 0 && ftruncate(file, 0) == 0 &&
               pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  try {
    const ReportFile report = read_report_file(path, WithCurves::yes);
    const Comparison comparison = compare(report, report, "fuzz");
    fuzz::demand(!to_json(comparison).empty() && !to_text(comparison, true).empty());
    for (const ComparedNumber& number : comparison.numbers)
      fuzz::demand(number.difference().value_or(0) == 0);
  } catch (const InputError&) {
  }
  return 0;
}
