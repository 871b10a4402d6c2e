#include "project_folder.h"

#include <cmath>

#include <tether/scenario/target.h>

/// Target files: the machines that SUTs run on. Input: the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::ProjectFolder folder;
  const auto file = folder.write("input.toml", {data, size});
  const auto read = fuzz::read_or_refuse([&] { return scenario::load_target(file); });
  if (!read) return 0;
  fuzz::require(!read->name.empty() && read->file.is_absolute(), "a target without a name");
  fuzz::require(std::isfinite(read->clock.factor) && read->clock.factor > 0.0, "a bad factor");
  fuzz::require(read->cores >= 0, "a negative number of cores");
  if (!read->ssh) return 0;
  // It becomes an argument of ssh.
  fuzz::require(!read->ssh->destination.starts_with('-'), "an address that is an option");
  const auto again = scenario::parse_ssh_address(scenario::to_string(*read->ssh));
  fuzz::require(again.destination == read->ssh->destination && again.port == read->ssh->port,
                "an address that reads otherwise once written");
  return 0;
}
