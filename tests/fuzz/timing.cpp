#include "project_folder.h"

#include <tether/timing/timing.h>

/// Timing files: what is accepted says the same once it was written and read again. Input: the
/// file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::ProjectFolder folder;
  const auto file = folder.write("input.timing", {data, size});
  const auto read = fuzz::read_or_refuse([&] { return timing::read_timing(file); });
  if (!read) return 0;
  fuzz::require(!read->runs.empty(), "a timing without a run");
  timing::write_timing(file, *read);
  const auto again = timing::read_timing(file);
  timing::write_timing(file, again);
  fuzz::require(timing::read_timing(file) == again, "a timing that reads otherwise once written");
  return 0;
}
