
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <tether/os/machine.h>

namespace tether::os {

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
  return cpu_model() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores, " +
         system.sysname + " " + system.release + " " + system.machine;
}

int machine_cores() {
  const long cores = sysconf(_SC_NPROCESSORS_CONF);
  return cores > 0 ? static_cast<int>(cores) : 0;
}

int separate_cores() {
  std::set<std::string> cores;
  for (const int cpu : allowed_cpus()) {
    const std::string name = "cpu" + std::to_string(cpu);
    std::ifstream file("/sys/devices/system/cpu/" + name + "/topology/thread_siblings_list");
    std::string siblings;
    cores.insert(std::getline(file, siblings) ? siblings : name);
  }
  return static_cast<int>(cores.size());
}

std::vector<int> allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) cpus.push_back(cpu);
  return cpus;
}

// "cpu  USER NICE SYSTEM IDLE IOWAIT IRQ SOFTIRQ STEAL …"
std::optional<ProcessorTime> parse_processor_time(std::string_view line, Duration tick) {
  std::istringstream fields{std::string(line)};
  std::string name;
  std::int64_t user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, soft_irq = 0, steal = 0;
  fields >> name >> user >> nice >> system >> idle >> io >> irq >> soft_irq >> steal;
  if (!fields || name != "cpu") return std::nullopt;
  return ProcessorTime{.used = tick * (user + nice + system + irq + soft_irq),
                       .stolen = tick * steal,
                       .idle = tick * (idle + io)};
}

std::optional<ProcessorTime> processor_time() {
  std::ifstream file("/proc/stat");
  std::string line;
  std::getline(file, line);
  return parse_processor_time(line, Duration(std::chrono::seconds(1)) / sysconf(_SC_CLK_TCK));
}

std::size_t allow_descriptors(std::size_t count) {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur < count) {
    limit.rlim_cur = std::min<rlim_t>(count, limit.rlim_max);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  return limit.rlim_cur;
}

}  // namespace tether::os
