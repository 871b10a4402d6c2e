#include "process_tree.h"

#include "freezer.h"
#include "waiting.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <linux/kcmp.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

// The processes below this one, read from /proc. `at_rest` decides from their states whether a
// freeze is complete. A thread in vfork() does not react to signals, but counts as stopped while
// the child that uses its memory is stopped.
namespace tether::supervisor {
namespace {

/// The text of a file of /proc; empty: its process has ended.
std::string read_text(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  std::string text;
  std::array<char, 4096> part;
  for (ssize_t size = 0; (size = ::read(file, part.data(), part.size())) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  ::close(file);
  return text;
}

std::vector<pid_t> numbers(const std::string& text) {
  std::vector<pid_t> found;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    pid_t number = 0;
    const auto parsed = std::from_chars(at, end, number);
    if (parsed.ec == std::errc()) found.push_back(number);
    at = parsed.ptr + 1;
  }
  return found;
}

std::string folder_of(pid_t process) {
  return "/proc/" + std::to_string(process) + "/task/";
}

std::vector<pid_t> threads_of(pid_t process) {
  std::vector<pid_t> found;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(folder_of(process).c_str()),
                                                   &::closedir);
  if (!folder) return found;
  while (const dirent* entry = ::readdir(folder.get())) {
    if (entry->d_name[0] != '.') found.push_back(std::atoi(entry->d_name));
  }
  return found;
}

/// Of /proc/PID/task/TID/stat: "TID (NAME) STATE PARENT GROUP …"; the name may hold anything.
struct ThreadState {
  char state = 'X';
  pid_t group = 0;
};
ThreadState thread_state(pid_t process, pid_t thread) {
  const std::string text = read_text(folder_of(process) + std::to_string(thread) + "/stat");
  const auto name_end = text.rfind(')');
  if (name_end == std::string::npos || text.size() < name_end + 5) return {};
  const std::vector<pid_t> ids = numbers(text.substr(name_end + 4));
  return {text[name_end + 2], ids.size() > 1 ? ids[1] : 0};
}

bool has_stopped_or_ended(char state) {
  constexpr std::string_view kStoppedTracedOrEnded = "TtZXx";
  return kStoppedTracedOrEnded.find(state) != std::string_view::npos;
}

std::string children_file(pid_t process, pid_t thread) {
  return folder_of(process) + std::to_string(thread) + "/children";
}

ProcessState process_state(pid_t process, pid_t parent) {
  ProcessState found{process, parent};
  for (const pid_t thread : threads_of(process)) {
    const ThreadState state = thread_state(process, thread);
    if (state.group != 0) found.group = state.group;
    if (state.state == 'D') {
      ++found.uninterruptible_threads;
    } else if (!has_stopped_or_ended(state.state)) {
      ++found.running_threads;
    }
  }
  return found;
}

std::string program_of(pid_t process) {
  std::array<char, 4096> path{};
  const std::string link = "/proc/" + std::to_string(process) + "/exe";
  const ssize_t size = ::readlink(link.c_str(), path.data(), path.size());
  return {path.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
}

/// How many children of `process` are at rest with memory that is its own too.
int children_at_rest(const std::vector<ProcessState>& processes, const std::vector<bool>& rest,
                     pid_t process, const std::function<bool(pid_t, pid_t)>& share_memory) {
  int count = 0;
  for (std::size_t i = 0; i < processes.size(); ++i) {
    if (processes[i].parent == process && rest[i] && share_memory(process, processes[i].id)) {
      ++count;
    }
  }
  return count;
}

/// Kills what has such a variable; false: nothing has.
bool kill_some_with(const std::string& beginning) {
  bool found = false;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir("/proc"), &::closedir);
  while (const dirent* entry = folder ? ::readdir(folder.get()) : nullptr) {
    const pid_t process = std::atoi(entry->d_name);
    if (process <= 0) continue;
    const std::string text = '\0' + read_text("/proc/" + std::string(entry->d_name) + "/environ");
    if (text.find('\0' + beginning) == std::string::npos) continue;
    found = ::kill(process, SIGKILL) == 0 || found;
  }
  return found;
}

}  // namespace

// A thread in vfork waits uninterruptibly. There are at most as many of them as children that share
// its memory; any other that waits so beside them is only within a system call, and stops at its
// end, before it computes.
std::vector<bool> at_rest(const std::vector<ProcessState>& processes,
                          const std::function<bool(pid_t, pid_t)>& share_memory) {
  std::vector<bool> rest(processes.size(), false);
  for (std::size_t i = processes.size(); i-- > 0;) {
    const ProcessState& process = processes[i];
    rest[i] = process.running_threads == 0 &&
              (process.uninterruptible_threads == 0 ||
               process.uninterruptible_threads <=
                   children_at_rest(processes, rest, process.id, share_memory));
  }
  return rest;
}

// Where the kernel may not be asked, the program says it nearly as well: one that has begun is
// another.
bool share_memory(pid_t parent, pid_t child) {
  const long order = ::syscall(SYS_kcmp, parent, child, KCMP_VM, 0, 0);
  if (order >= 0) return order == 0;
  const std::string program = program_of(parent);
  return !program.empty() && program == program_of(child);
}

bool ProcessTree::is_listed() {
  return ::access(children_file(::getpid(), ::getpid()).c_str(), R_OK) == 0;
}

std::vector<ProcessState> ProcessTree::look() const {
  std::vector<ProcessState> found;
  look_below(::getpid(), found);
  return found;
}

std::vector<pid_t> ProcessTree::own_children() const {
  std::vector<pid_t> found = numbers(read_text(children_file(::getpid(), ::getpid())));
  found.erase(std::remove(found.begin(), found.end(), except_), found.end());
  return found;
}

// A process's state before its children: one that is stopped starts no more.
void ProcessTree::look_below(pid_t process, std::vector<ProcessState>& found) const {
  for (const pid_t thread : threads_of(process)) {
    for (const pid_t child : numbers(read_text(children_file(process, thread)))) {
      if (child == except_) continue;
      found.push_back(process_state(child, process));
      look_below(child, found);
    }
  }
}

void ProcessTree::kill_all() const {
  wait_until(
      [this] {
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        const auto left = look();
        for (const ProcessState& process : left) ::kill(process.id, SIGKILL);
        return left.empty();
      },
      kLongestFreeze);
}

void kill_all_with(const std::string& beginning) {
  wait_until([&beginning] { return !kill_some_with(beginning); }, kLongestFreeze);
}

}  // namespace tether::supervisor
