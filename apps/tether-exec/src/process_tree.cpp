#include "process_tree.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace tether::exec {
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

bool is_at_rest(char state) {
  constexpr std::string_view kStoppedTracedOrEnded = "TtZXx";
  return kStoppedTracedOrEnded.find(state) != std::string_view::npos;
}

std::string children_file(pid_t process, pid_t thread) {
  return folder_of(process) + std::to_string(thread) + "/children";
}

}  // namespace

bool ProcessTree::is_listed() {
  return ::access(children_file(::getpid(), ::getpid()).c_str(), R_OK) == 0;
}

bool ProcessTree::all_stopped(pid_t group) {
  return stopped_below(::getpid(), group);
}

bool ProcessTree::stopped_below(pid_t process, pid_t group) {
  for (const pid_t thread : threads_of(process)) {
    for (const pid_t child : numbers(read_text(children_file(process, thread)))) {
      for (const pid_t its_thread : threads_of(child)) {
        const ThreadState state = thread_state(child, its_thread);
        if (state.group == group && !is_at_rest(state.state)) return false;
      }
      if (!stopped_below(child, group)) return false;
    }
  }
  return true;
}

}  // namespace tether::exec
