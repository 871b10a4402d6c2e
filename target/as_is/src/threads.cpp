#include "threads.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/link/messages.h>

namespace tether::as_is {
namespace {

/// A file of /proc, whole.
bool read_file(const char* path, char* text, std::size_t size) {
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const ssize_t got = ::read(file, text, size - 1);
  ::close(file);
  if (got <= 0) return false;
  text[got] = '\0';
  return true;
}

// Sleeping, stopped by a debugger, or dead: nothing happens there until somebody else acts.
bool is_waiting(char state) {
  return std::strchr("SZXxtT", state) != nullptr;
}

/// How often all other threads have been scheduled; none: one of them does not wait.
std::optional<unsigned long> turns_of_others() {
  DIR* const folder = ::opendir("/proc/self/task");
  if (folder == nullptr) return std::nullopt;
  const std::string self = std::to_string(::syscall(SYS_gettid));
  std::optional<unsigned long> turns = 0;
  while (const dirent* entry = ::readdir(folder)) {
    if (entry->d_name[0] == '.' || self == entry->d_name) continue;
    char path[64], text[512];
    std::snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", entry->d_name);
    if (!read_file(path, text, sizeof text)) continue;  // it has ended
    const char* after_name = std::strrchr(text, ')');
    if (after_name == nullptr || !is_waiting(after_name[2])) {
      turns.reset();
      break;
    }
    std::snprintf(path, sizeof path, "/proc/self/task/%.20s/schedstat", entry->d_name);
    if (!read_file(path, text, sizeof text)) continue;
    const char* last = std::strrchr(text, ' ');
    if (last != nullptr) *turns += std::strtoul(last, nullptr, 10);
  }
  ::closedir(folder);
  return turns;
}

/// Whether a child of this process, or of those, runs or could. Of those that wait, nothing is
/// known of for what.
bool is_child_running(const std::string& task_folder, int depth) {
  constexpr int kDeepest = 8;
  DIR* const folder = ::opendir(task_folder.c_str());
  if (folder == nullptr) return false;
  bool is_running = false;
  while (const dirent* entry = ::readdir(folder)) {
    if (entry->d_name[0] == '.' || is_running) continue;
    char text[4096];
    const std::string file = task_folder + "/" + entry->d_name + "/children";
    if (!read_file(file.c_str(), text, sizeof text)) continue;
    std::istringstream children(text);
    for (std::string child; children >> child && !is_running;) {
      char stat[512];
      const bool is_there = read_file(("/proc/" + child + "/stat").c_str(), stat, sizeof stat);
      const char* after_name = is_there ? std::strrchr(stat, ')') : nullptr;
      is_running = after_name != nullptr && !is_waiting(after_name[2]);
      if (depth < kDeepest)
        is_running = is_running || is_child_running("/proc/" + child + "/task", depth + 1);
    }
  }
  ::closedir(folder);
  return is_running;
}

bool has_children() {
  siginfo_t info{};
  return ::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0 || errno != ECHILD;
}

}  // namespace

std::atomic<int> Threads::count_ = 1;
std::atomic<int> Threads::outside_ = 0;

client::Computed Threads::computed() {
  client::Computed computed;
  DIR* const folder = ::opendir("/proc/self/task");
  if (folder == nullptr) return computed;
  while (const dirent* entry = ::readdir(folder)) {
    const std::string thread = std::string("/proc/self/task/") + entry->d_name;
    char name[64], used[64];
    if (entry->d_name[0] == '.' || !read_file((thread + "/comm").c_str(), name, sizeof name) ||
        !read_file((thread + "/schedstat").c_str(), used, sizeof used))
      continue;
    name[std::strcspn(name, "\n")] = '\0';
    if (std::string_view(name) != link::kClientThread)
      computed[name] += Duration(std::strtoll(used, nullptr, 10));
  }
  ::closedir(folder);
  return computed;
}

bool Threads::are_others_waiting() {
  if (outside_ > 0 || (has_children() && is_child_running("/proc/self/task", 0))) return false;
  if (!are_several()) return true;
  const auto first = turns_of_others();
  return first && turns_of_others() == first;
}

}  // namespace tether::as_is
