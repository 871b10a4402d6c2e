#include "connection.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include <malloc.h>
#include <sys/utsname.h>

#include <tether/base/version.h>
#include <tether/calibration/calibration.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/rig/device_arguments.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::sut {
namespace {

/// Does everything that is slow only once, before the SUT's time begins. Vision uses one thread,
/// because the SUT's time may be the CPU time of this process. The allocator keeps freed images,
/// because new memory for each would take most of the time of handling it.
void prepare() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
  vision::set_threads(1);
  vision::warm_up(640, 480);
}

/// Options override the environment.
void override_environment(const CommandLine& line) {
  const auto set = [](const char* name, const std::optional<std::string>& value) {
    if (value) setenv(name, value->c_str(), 1);
  };
  set("TETHER_ADDRESS", line.address);
  set("TETHER_UAV", line.uav);
  set("TETHER_CLOCK", line.clock);
}

/// "cpu × 6". From the environment, because the vehicle knows its clock only without tether-exec.
std::string clock_text() {
  const char* clock = std::getenv("TETHER_CLOCK");
  std::string text = clock == nullptr || *clock == '\0' ? "wall" : clock;
  if (const std::size_t sign = text.find('*'); sign != std::string::npos)
    text.replace(sign, 1, " × ");
  return text;
}

Result<Connection> open_devices(const devices::Rig& rig) {
  Result<std::unique_ptr<client::Vehicle>> vehicle = devices::open_rig(rig);
  if (!vehicle) return Failure{Failure::Kind::kRefused, vehicle.failure().message};
  rig::catch_interrupts();
  return Connection{rig::make_interruptible(std::move(vehicle).value(), rig::interrupted),
                    {"real sensor", calibration::host_name()},
                    true};
}

}  // namespace

std::string in_run_folder(const std::string& path) {
  const char* folder = std::getenv("TETHER_OUT");
  if (path.empty() || folder == nullptr || *folder == '\0') return path;
  return (std::filesystem::path(folder) / path).string();
}

/// With the kind of machine, for the record: "tether-sut 0.1.0 (aarch64)".
std::string name_of_this_program() {
  utsname system{};
  ::uname(&system);
  return "tether-sut " + std::string(tether::version()) + " (" + system.machine + ")";
}

Result<Connection> connect_as(const CommandLine& line) {
  if (line.rig) {
    prepare();
    return open_devices(*line.rig);
  }
  override_environment(line);
  Result<client::ConnectOptions> options = client::options_from_environment();
  if (!options) return options.failure();
  options->sut_name = name_of_this_program();
  const std::string location = calibration::host_name() + ", " + clock_text();
  prepare();
  Result<std::unique_ptr<client::Vehicle>> vehicle = client::connect(std::move(options).value());
  if (!vehicle) return vehicle.failure();
  return Connection{std::move(vehicle).value(), {"virtual", location}, false};
}

}  // namespace tether::sut
