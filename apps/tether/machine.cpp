#include "machine.h"

#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <tether/sync/clock_witness.h>

namespace tether::app {

namespace {
std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.rfind("model name", 0) == 0 || line.rfind("Model", 0) == 0)
      return line.substr(line.find(':') + 2);
  return "unknown CPU";
}
}  // namespace

std::string describe_machine() {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {} cores, {} {} {}", cpu_model(), std::thread::hardware_concurrency(),
                     system.sysname, system.release, system.machine);
}

int machine_cores() {
  const long cores = sysconf(_SC_NPROCESSORS_CONF);
  return cores > 0 && cores <= sync::kMostCores ? static_cast<int>(cores) : 0;
}

}  // namespace tether::app
