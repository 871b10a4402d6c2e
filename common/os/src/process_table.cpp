#include <array>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>
#include <tether/os/process_table.h>

namespace tether::os {

namespace {

/// None: the file does not exist, or its process has ended.
std::optional<std::string> text_of(const std::string& file) {
  const FileDescriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor) return std::nullopt;
  std::string text;
  std::array<char, 4096> part;
  ssize_t size = 0;
  while ((size = read(descriptor.get(), part.data(), part.size())) > 0)
    text.append(part.data(), static_cast<std::size_t>(size));
  return size == 0 ? std::optional(text) : std::nullopt;
}

/// Entries of a folder that are numbers.
std::vector<pid_t> numbers_in(const std::string& folder) {
  std::vector<pid_t> found;
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(opendir(folder.c_str()), &closedir);
  while (const dirent* entry = entries ? readdir(entries.get()) : nullptr) {
    const std::string_view name = entry->d_name;
    pid_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size()) found.push_back(number);
  }
  return found;
}

std::string folder_of(pid_t process) {
  return "/proc/" + std::to_string(process);
}

std::vector<pid_t> listed_children(pid_t process) {
  const std::string threads = folder_of(process) + "/task/";
  std::vector<pid_t> found;
  for (const pid_t thread : numbers_in(threads)) {
    std::istringstream list(
        text_of(threads + std::to_string(thread) + "/children").value_or(std::string()));
    for (pid_t child = 0; list >> child;) found.push_back(child);
  }
  return found;
}

bool lists_children() {
  static const bool lists =
      access((folder_of(getpid()) + "/task/" + std::to_string(getpid()) + "/children").c_str(),
             R_OK) == 0;
  return lists;
}

}  // namespace

// "PID (NAME) STATE PARENT GROUP …", fields from 1 as in proc(5); the name may contain anything.
std::optional<ProcessStat> process_stat(pid_t process) {
  const auto text = text_of(folder_of(process) + "/stat");
  const auto name_end = text ? text->rfind(')') : std::string::npos;
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream rest(text->substr(name_end + 1));
  ProcessStat stat;
  rest >> stat.state;
  constexpr std::size_t kParent = 4, kGroup = 5, kWaitedUser = 16, kWaitedSystem = 17,
                        kIgnored = 33;
  std::array<std::string, kIgnored + 1> fields;  // some exceed every integer
  for (std::size_t i = kParent; i <= kIgnored; ++i) rest >> fields[i];
  if (!rest) return std::nullopt;
  const auto number = [&](std::size_t i) { return std::strtoll(fields[i].c_str(), nullptr, 10); };
  stat.parent = static_cast<pid_t>(number(kParent));
  stat.group = static_cast<pid_t>(number(kGroup));
  const Duration tick = Duration(std::chrono::seconds(1)) / sysconf(_SC_CLK_TCK);
  stat.waited_children = tick * (number(kWaitedUser) + number(kWaitedSystem));
  stat.ignores_child_end = ((number(kIgnored) >> (SIGCHLD - 1)) & 1) != 0;
  return stat;
}

std::vector<pid_t> all_processes() {
  return numbers_in("/proc");
}

std::vector<pid_t> children_of(pid_t process) {
  if (lists_children()) return listed_children(process);
  std::vector<pid_t> found;
  for (const pid_t other : all_processes())
    if (const auto stat = process_stat(other); stat && stat->parent == process)
      found.push_back(other);
  return found;
}

void adopt_orphans() {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
}

}  // namespace tether::os
