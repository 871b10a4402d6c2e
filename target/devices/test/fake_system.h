#pragma once

#include "system.h"

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tether::devices {

/// The machine's own system calls, with faults and devices planted by path.
class FakeSystem final : public System {
 public:
  /// Device nodes that are not really there; their calls go to `on_ioctl`.
  std::map<std::string, FileKind> nodes;
  std::map<std::string, int> open_errors;
  /// What the next reads of a file give; 0: its real text. The last one stays.
  std::map<std::string, std::deque<int>> read_errors;
  std::function<int(unsigned long, void*)> on_ioctl = [](unsigned long, void*) { return -25; };
  std::function<void()> before_read = [] {};
  int open_descriptors = 0;
  int reads = 0;

  int stat(const std::string& path, FileKind& kind) override {
    const auto node = nodes.find(path);
    if (node == nodes.end()) return real_system().stat(path, kind);
    kind = node->second;
    return 0;
  }
  int open(const std::string& path, bool writable) override {
    if (const auto error = open_errors.find(path); error != open_errors.end()) {
      return -error->second;
    }
    const bool planted = nodes.contains(path);
    const int descriptor = planted ? kFirstPlanted + next_++ : real_system().open(path, writable);
    if (descriptor >= 0) {
      paths_[descriptor] = path;
      ++open_descriptors;
    }
    return descriptor;
  }
  void close(int descriptor) override {
    --open_descriptors;
    if (descriptor < kFirstPlanted) real_system().close(descriptor);
  }
  long read_again(int descriptor, char* buffer, std::size_t size) override {
    ++reads;
    before_read();
    std::deque<int>& errors = read_errors[paths_[descriptor]];
    const int error = errors.empty() ? 0 : errors.front();
    if (errors.size() > 1) errors.pop_front();
    return error != 0 ? -error : real_system().read_again(descriptor, buffer, size);
  }
  int ioctl(int, unsigned long request, void* argument) override {
    return on_ioctl(request, argument);
  }
  std::vector<std::string> list(const std::string& folder) override {
    return real_system().list(folder);
  }

 private:
  static constexpr int kFirstPlanted = 1'000'000;

  int next_ = 0;
  std::map<int, std::string> paths_;
};

}  // namespace tether::devices
