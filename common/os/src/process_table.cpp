#include <algorithm>
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
#include <sys/resource.h>
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

std::string threads_of(pid_t process) {
  return folder_of(process) + "/task/";
}

std::vector<pid_t> listed_children(pid_t process) {
  const std::string threads = threads_of(process);
  std::vector<pid_t> found;
  for (const pid_t thread : numbers_in(threads)) {
    std::istringstream list(
        text_of(threads + std::to_string(thread) + "/children").value_or(std::string()));
    for (pid_t child = 0; list >> child;) found.push_back(child);
  }
  return found;
}

void count(const std::string& stat, std::string_view left_out, ThreadStates& sum) {
  const auto begin = stat.find('('), end = stat.rfind(')');
  if (begin == std::string::npos || end == std::string::npos || end + 2 >= stat.size()) return;
  const char state = stat[end + 2];
  if (!left_out.empty() && std::string_view(stat).substr(begin + 1, end - begin - 1) == left_out) {
    if (state == 'R') ++sum.left_out_runnable;
    return;
  }
  switch (state) {
    case 'R':
      ++sum.runnable;
      break;
    case 'D':
      ++sum.on_disk;
      break;
    case 'T':
    case 't':
      ++sum.halted;
      break;
    case 'Z':
    case 'X':
      break;
    default:
      ++sum.waiting;
  }
}

void add_states(pid_t process, std::string_view left_out, ThreadStates& sum) {
  const std::string threads = threads_of(process);
  for (const pid_t thread : numbers_in(threads))
    if (const auto stat = text_of(threads + std::to_string(thread) + "/stat"))
      count(*stat, left_out, sum);
  for (const pid_t child : children_of(process)) add_states(child, left_out, sum);
}

/// The third number of /proc/PID/task/TID/schedstat.
std::uint64_t turns_in(const std::string& schedstat) {
  std::istringstream fields(schedstat);
  std::uint64_t running_ns = 0, waiting_ns = 0, turns = 0;
  fields >> running_ns >> waiting_ns >> turns;
  return turns;
}

void add_turns(pid_t process, std::uint64_t& turns) {
  const std::string threads = threads_of(process);
  for (const pid_t thread : numbers_in(threads))
    turns += turns_in(text_of(threads + std::to_string(thread) + "/schedstat").value_or("0"));
  for (const pid_t child : children_of(process)) add_turns(child, turns);
}

Duration used_below(pid_t process) {
  Duration used{0};
  for (const pid_t child : children_of(process))
    if (const auto stat = process_stat(child))
      used += stat->used + stat->waited_children + used_below(child);
  return used;
}

Duration used_by(int whom) {
  rusage usage{};
  getrusage(whom, &usage);
  Duration used{0};
  for (const timeval& part : {usage.ru_utime, usage.ru_stime})
    used += std::chrono::seconds(part.tv_sec) + std::chrono::microseconds(part.tv_usec);
  return used;
}

/// The number in "0100007F:A5C2" after the colon; 0: there is none.
std::uint16_t port_in(std::string_view end_point) {
  std::uint16_t port = 0;
  const auto colon = end_point.find(':');
  if (colon != std::string_view::npos)
    std::from_chars(end_point.data() + colon + 1, end_point.data() + end_point.size(), port, 16);
  return port;
}

/// The link that a descriptor of such a connection has in /proc/PID/fd; empty: there is none.
std::string socket_link(const std::string& table, std::uint16_t local, std::uint16_t remote) {
  std::istringstream lines(text_of(table).value_or(std::string()));
  constexpr std::size_t kLocal = 1, kRemote = 2, kInode = 9;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::array<std::string, kInode + 1> field;
    for (std::string& text : field) fields >> text;
    if (fields && port_in(field[kLocal]) == local && port_in(field[kRemote]) == remote)
      return "socket:[" + field[kInode] + "]";
  }
  return "";
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
  constexpr std::size_t kParent = 4, kGroup = 5, kUser = 14, kSystem = 15, kWaitedUser = 16,
                        kWaitedSystem = 17, kIgnored = 33;
  std::array<std::string, kIgnored + 1> fields;  // some exceed every integer
  for (std::size_t i = kParent; i <= kIgnored; ++i) rest >> fields[i];
  if (!rest) return std::nullopt;
  const auto number = [&](std::size_t i) { return std::strtoll(fields[i].c_str(), nullptr, 10); };
  stat.parent = static_cast<pid_t>(number(kParent));
  stat.group = static_cast<pid_t>(number(kGroup));
  const Duration tick = Duration(std::chrono::seconds(1)) / sysconf(_SC_CLK_TCK);
  stat.used = tick * (number(kUser) + number(kSystem));
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

ThreadStates thread_states(pid_t process, std::string_view left_out) {
  ThreadStates sum;
  add_states(process, left_out, sum);
  return sum;
}

std::uint64_t turns_of(pid_t process) {
  std::uint64_t turns = 0;
  add_turns(process, turns);
  return turns;
}

bool has_connection(pid_t process, std::uint16_t local_port, std::uint16_t remote_port) {
  const std::string folder = folder_of(process);
  std::array<char, 64> target{};
  for (const char* table : {"/net/tcp", "/net/tcp6"}) {
    const std::string link = socket_link(folder + table, local_port, remote_port);
    if (link.empty()) continue;
    const auto descriptors = numbers_in(folder + "/fd");
    return std::ranges::any_of(descriptors, [&](pid_t descriptor) {
      const std::string file = folder + "/fd/" + std::to_string(descriptor);
      const ssize_t size = readlink(file.c_str(), target.data(), target.size());
      return size > 0 && std::string_view(target.data(), static_cast<std::size_t>(size)) == link;
    });
  }
  return false;
}

Duration used_with_descendants() {
  return used_by(RUSAGE_SELF) + used_by(RUSAGE_CHILDREN) + used_below(getpid());
}

void adopt_orphans() {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
}

}  // namespace tether::os
