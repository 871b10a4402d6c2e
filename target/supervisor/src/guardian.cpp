#include "guardian.h"

#include "freezer.h"
#include "process_tree.h"

#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tether::supervisor {
namespace {

/// Reads process groups until the other end is gone; a negative one is to be forgotten.
std::set<pid_t> read_until_end(int pipe) {
  std::set<pid_t> groups;
  pid_t next = 0;
  while (true) {
    const ssize_t size = ::read(pipe, &next, sizeof next);
    if (size == static_cast<ssize_t>(sizeof next) && groups.erase(-next) == 0) groups.insert(next);
    if (size == 0 || (size < 0 && errno != EINTR)) return groups;
  }
}

/// The guardian's life. It holds nothing open that anybody might wait for, and no terminal's or
/// parent's signal ends it.
void guard(int pipe, const std::string& folder, const std::string& cgroup) {
  ::setsid();
  sigset_t all;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int standard = 0; standard < 3; ++standard) ::dup2(nothing, standard);
  for (int other = 3; other < 64; ++other) {
    if (other != pipe) ::close(other);
  }
  for (const pid_t group : read_until_end(pipe)) ::kill(-group, SIGKILL);
  kill_all_with("TETHER_EXEC=" + folder + "/");
  if (!cgroup.empty()) remove_cgroup(cgroup);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

}  // namespace

Guardian::Guardian(const std::string& folder, const std::string& cgroup) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  const os::FileDescriptor reading(ends[0]);
  pipe_ = os::FileDescriptor(ends[1]);
  process_ = ::fork();
  if (process_ != 0) return;
  pipe_ = os::FileDescriptor();
  guard(reading.get(), folder, cgroup);
  ::_exit(0);
}

Guardian::~Guardian() {
  if (process_ <= 0) return;
  pipe_ = os::FileDescriptor();
  ::waitpid(process_, nullptr, 0);
}

void Guardian::watch(pid_t group) {
  static_cast<void>(!::write(pipe_.get(), &group, sizeof group));
}

void Guardian::forget(pid_t group) {
  watch(-group);
}

}  // namespace tether::supervisor
