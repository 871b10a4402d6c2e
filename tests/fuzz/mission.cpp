#include "fuzz_target.h"
#include "rig_file.h"

#include <set>

#include <tether/rig/mission.h>

/// Mission files and rig files: what people write for `tether-sut`. Input: the file, read as both.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  const std::string text = fuzz::text_of({data, size});
  const auto kinds = {Failure::Kind::kInvalid};
  const auto mission = rig::parse_mission(text, "input.toml");
  if (const auto* read = fuzz::value_or_refused(mission, kinds)) {
    fuzz::require(!read->tasks.empty() && read->is_sequence, "a mission of nothing");
  }
  const auto rig = rig::parse_rig(text, "input.toml");
  if (const auto* read = fuzz::value_or_refused(rig, kinds)) {
    std::set<std::string> names;
    for (const auto& sensor : read->sensors)
      fuzz::require(names.insert(sensor.description.name).second, "two sensors of one name");
  }
  return 0;
}
