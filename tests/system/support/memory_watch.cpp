#include "memory_watch.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>

namespace tether::system_test {
namespace {

/// Largest memory that the process has had so far [KiB]; 0: it has ended.
long peak_memory_KiB(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
  return 0;
}

}  // namespace

MemoryWatch::MemoryWatch(pid_t pid)
    : most_KiB_(peak_memory_KiB(pid)), thread_([this, pid](const std::stop_token& end) {
        while (!end.stop_requested()) {
          most_KiB_ = std::max(most_KiB_.load(), peak_memory_KiB(pid));
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
      }) {}

}  // namespace tether::system_test
