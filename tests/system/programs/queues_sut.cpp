// Reads sensors as drivers deliver them: queues_sut IMAGES QUEUE
//
// Flies ahead and turns, and for each of IMAGES images reads all IMU measurements that arrived
// since the last one, from a queue of QUEUE measurements, and the pair of both cameras. Its end has
// how many IMU measurements it got, how many were lost, and how many pairs were of two instants.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <tether/client/simulated_vehicle.h>

namespace {

using tether::client::Vehicle;
using tether::uav::CameraSample;
using tether::uav::ImuSample;

template <class T>
T require(tether::Result<T> result) {
  if (result) return std::move(result).value();
  std::fprintf(stderr, "queues_sut: %s\n", result.failure().message.c_str());
  std::_Exit(3);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto vehicle =
      require(tether::client::connect(require(tether::client::options_from_environment())));
  require(vehicle->set_queue("imu", static_cast<std::uint32_t>(std::stoul(argv[2]))));
  for (const char* camera : {"left", "right"}) require(vehicle->set_queue(camera, 4));
  require(vehicle->command_velocity({{0.3, 0.0, 0.0}, 0.3}));
  unsigned long got = 0, lost = 0, apart = 0;
  std::uint64_t next = 0;
  for (int image = 0; image < std::stoi(argv[1]); ++image) {
    const auto pair =
        require(tether::client::read_together<CameraSample>(*vehicle, {"left", "right"}));
    if (pair[0].sampled_at != pair[1].sampled_at) ++apart;
    for (const auto& sample : require(tether::client::read_all<ImuSample>(*vehicle, "imu"))) {
      if (got > 0) lost += sample.index - next;
      next = sample.index + 1;
      ++got;
    }
  }
  const std::string details = "{\"got\": " + std::to_string(got) +
                              ", \"lost\": " + std::to_string(lost) +
                              ", \"apart\": " + std::to_string(apart) + "}";
  require(vehicle->finish(true, "done", details));
}
