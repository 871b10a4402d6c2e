#include "simulator_script.h"
#include "socket_connection.h"
#include "socket_pair.h"

#include <tether/sim_remote/remote_simulator.h>

/// The host's side of the simulator protocol, with a simulator that has said everything beforehand.
/// Input: what it says.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::SpokenFor simulator({data, size});
  auto connection = sim::protocol::make_connection(simulator.take_ours(), "simulator");
  const auto flown = [&] {
    const auto remote = sim::make_remote_simulator(
        fuzz::scripted_world(), std::move(connection), {},
        [](const std::string& warning) { fuzz::require_one_line(warning); });
    fuzz::fly_script(*remote);
    fuzz::require_one_line(remote->description());
    return true;
  };
  (void)fuzz::read_or_refuse(flown, {ErrorCode::kSetup});
  return 0;
}
