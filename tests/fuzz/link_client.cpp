#include "socket_channel.h"
#include "socket_pair.h"

#include <memory>

#include <tether/client/simulated_vehicle.h>
#include <tether/client_testing/manual_time_source.h>

/// The SUT's side: handshake and calls, with a coordinator that has said everything beforehand.
/// Input: what it says.
namespace tether::fuzz {
namespace {

using client::Read;
using Kind = Failure::Kind;

constexpr std::initializer_list<Kind> kExpected = {Kind::kRefused,  Kind::kDisconnected,
                                                   Kind::kProtocol, Kind::kRunEnded,
                                                   Kind::kInvalid,  Kind::kNothingYet};

/// After a failure that ends it, a vehicle says the same for ever.
class Calls {
 public:
  template <class T>
  void made(const Result<T>& result) {
    const T* value = value_or_refused(result, kExpected);
    require(value == nullptr || !over_, "a call that succeeds after the end");
    if (value != nullptr) return;
    const Kind kind = result.failure().kind;
    if (kind != Kind::kInvalid && kind != Kind::kNothingYet) over_ = true;
  }

 private:
  bool over_ = false;
};

void fly(client::Vehicle& vehicle) {
  Calls calls;
  ExecTime before = vehicle.now();
  for (const Read read : {Read::kNext, Read::kLatest, Read::kIfAvailable}) {
    for (const auto& sensor : vehicle.catalogue().sensors) {
      calls.made(vehicle.read<uav::CameraSample>(sensor.name, read));
      calls.made(vehicle.read<uav::ImuSample>(sensor.name, read));
      calls.made(vehicle.read<uav::RangeSample>(sensor.name, read));
      calls.made(vehicle.read<uav::NavSatSample>(sensor.name, read));
      calls.made(vehicle.read<uav::ScanSample>(sensor.name, read));
    }
    calls.made(vehicle.command_velocity({}));
    calls.made(vehicle.command({.mask = uav::kPosition, .in_heading = false}));
    calls.made(vehicle.annotate("roi", "{}"));
    calls.made(vehicle.sleep_for(Duration(1)));
    require(vehicle.now() >= before, "ET goes back");
    before = vehicle.now();
  }
  calls.made(vehicle.finish(true, "done", "{}"));
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::SpokenFor coordinator({data, size});
  client::ConnectOptions options;
  options.sut_name = "fuzz";
  options.time = std::make_unique<client_testing::ManualTimeSource>();
  options.heartbeat_period = Duration::zero();
  auto vehicle = client::connect(link::make_socket_channel(coordinator.take_ours(), "coordinator"),
                                 std::move(options));
  if (fuzz::value_or_refused(vehicle, fuzz::kExpected) != nullptr) fuzz::fly(**vehicle);
  return 0;
}
