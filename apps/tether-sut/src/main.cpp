#include "command_line.h"
#include "mission.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <utility>

#include <malloc.h>

#include <tether/base/version.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/vision/runtime.h>

namespace tether::sut {
namespace {

/// Before the SUT's time begins: all that is slow only once. One thread, because the SUT's time may
/// be the CPU time of this process; freed images stay with the allocator, because fetching fresh
/// memory for each would be most of what handling one costs.
void prepare() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
  vision::set_threads(1);
  vision::warm_up(640, 480);
}

/// The command line's word counts for more than the environment's.
void override_environment(const CommandLine& line) {
  const auto set = [](const char* name, const std::optional<std::string>& value) {
    if (value) {
      setenv(name, value->c_str(), 1);
    }
  };
  set("TETHER_ADDRESS", line.address);
  set("TETHER_UAV", line.uav);
  set("TETHER_CLOCK", line.clock);
}

Result<std::unique_ptr<client::Vehicle>> connect_as(const CommandLine& line) {
  override_environment(line);
  Result<client::ConnectOptions> options = client::options_from_environment();
  if (!options) {
    return options.failure();
  }
  options->sut_name = "tether-sut " + std::string(tether::version());
  prepare();
  return client::connect(std::move(options).value());
}

int run(int argc, char** argv) {
  const auto parsed = parse_command_line(argc, argv);
  if (const auto* refused = std::get_if<Refusal>(&parsed)) {
    (refused->exit_code == 0 ? std::cout : std::cerr) << refused->text;
    return refused->exit_code;
  }
  const auto& line = std::get<CommandLine>(parsed);
  const Result<std::unique_ptr<client::Vehicle>> vehicle = connect_as(line);
  if (!vehicle) {
    std::cerr << "tether-sut: " << vehicle.failure().message << '\n';
    return exit_code(vehicle.failure());
  }
  const tasks::TaskOutcome outcome = fly(line.mission, **vehicle);
  if (outcome.status == tasks::TaskStatus::kFailed) {
    std::cerr << "tether-sut: " << outcome.reason << '\n';
  } else {
    std::cout << tasks::details_json(outcome) << '\n';
  }
  return exit_code(outcome);
}

}  // namespace
}  // namespace tether::sut

int main(int argc, char** argv) {
  try {
    return tether::sut::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "tether-sut: " << error.what() << '\n';
    return 3;
  }
}
