// The software under test of bench/soak: reads the IMU and sends a command after each reading,
// until it has made as many interactions as its argument says.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <tether/client/simulated_vehicle.h>

namespace {

using tether::Status;
using tether::client::Vehicle;

int fail(const tether::Failure& failure) {
  std::fprintf(stderr, "soak_sut: %s\n", failure.message.c_str());
  return 3;
}

// Slow turns to and fro, so that it stays where it is.
Status turn(Vehicle& vehicle, std::uint64_t i) {
  return vehicle.command_velocity({{}, i % 2000 < 1000 ? 0.1 : -0.1});
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t interactions = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 0;
  auto options = tether::client::options_from_environment();
  if (!options) return fail(options.failure());
  options->sut_name = "soak_sut";
  const auto vehicle = tether::client::connect(std::move(*options));
  if (!vehicle) return fail(vehicle.failure());
  // The last one is the end.
  for (std::uint64_t i = 1; i < interactions; i += 2) {
    if (const auto imu = (*vehicle)->read<tether::uav::ImuSample>("imu"); !imu)
      return fail(imu.failure());
    if (i + 1 == interactions) break;
    if (const Status sent = turn(**vehicle, i / 2); !sent) return fail(sent.failure());
  }
  if (const Status end = (*vehicle)->finish(true, "as many interactions as wanted", "{}"); !end)
    return fail(end.failure());
  return 0;
}
