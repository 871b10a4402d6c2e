#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <tether/calibration/calibration.h>

namespace tether::calibration {
namespace {

/// The first line, up to a NUL; empty if there is none.
std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line.substr(0, line.find('\0'));
}

/// The value of the first "key : value" of /proc/cpuinfo.
std::string cpuinfo(const std::string& root, const std::string& key) {
  std::ifstream file(root + "/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind(key, 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

/// A board's own name says more than its cores'.
std::string cpu_model(const std::string& root) {
  std::string model = first_line(root + "/proc/device-tree/model");
  if (model.empty()) model = cpuinfo(root, "model name");
  return model.empty() ? cpuinfo(root, "Model") : model;
}

std::string frequency_folder(int cpu_index, const std::string& root) {
  return root + "/sys/devices/system/cpu/cpu" + std::to_string(cpu_index) + "/cpufreq/";
}

double number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? 0.0 : value;
}

std::optional<cpu_set_t> allowed() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? std::optional(set) : std::nullopt;
}

int last_of(const cpu_set_t& set) {
  int cpu = CPU_SETSIZE - 1;
  while (cpu > 0 && !CPU_ISSET(static_cast<std::size_t>(cpu), &set)) --cpu;
  return cpu;
}

}  // namespace

std::string host_name() {
  std::array<char, 256> name{};
  const bool is_known = gethostname(name.data(), name.size() - 1) == 0 && name.front() != '\0';
  return is_known ? name.data() : "unknown host";
}

Machine read_machine(const std::string& root) {
  Machine machine;
  utsname system{};
  ::uname(&system);
  machine.name = host_name();
  machine.cpu = cpu_model(root);
  machine.architecture = system.machine;
  if (const auto set = allowed()) machine.cores = CPU_COUNT(&*set);
  return machine;
}

double read_mhz(int cpu_index, const std::string& root) {
  const double khz = number_of(first_line(frequency_folder(cpu_index, root) + "scaling_cur_freq"));
  return khz > 0.0 ? khz / 1e3 : number_of(cpuinfo(root, "cpu MHz"));
}

void read_governor(int cpu_index, Machine& machine, const std::string& root) {
  machine.governor = first_line(frequency_folder(cpu_index, root) + "scaling_governor");
}

Result<int> bind_to_core(std::optional<int> cpu_index) {
  const auto set = allowed();
  if (!set) {
    return Failure{Failure::Kind::kInvalid, "cannot read which cores this program can use"};
  }
  const int cpu = cpu_index.value_or(last_of(*set));
  cpu_set_t one;
  CPU_ZERO(&one);
  if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &one);
  if (sched_setaffinity(0, sizeof one, &one) != 0) {
    return Failure{Failure::Kind::kInvalid,
                   "core " + std::to_string(cpu) + " is not available to this program"};
  }
  return cpu;
}

}  // namespace tether::calibration
