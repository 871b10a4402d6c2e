#include "command.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>

namespace tether::supervisor {
namespace {

using os::FileDescriptor;

/// Puts the child where its command belongs; false: the system refuses, with the reason in errno.
bool settle(const Command& command, const std::string& socket) {
  const auto [folder, input, output, errors] = command.descriptors;
  if (folder >= 0 && ::fchdir(folder) != 0) return false;
  for (const auto& [from, to] : {std::pair(input, STDIN_FILENO), std::pair(output, STDOUT_FILENO),
                                 std::pair(errors, STDERR_FILENO)})
    if (from >= 0 && ::dup2(from, to) < 0) return false;
  if (command.environment) {
    ::clearenv();
    // putenv does not change what it points to.
    for (const auto& variable : *command.environment) ::putenv(const_cast<char*>(variable.c_str()));
  }
  return ::setenv("TETHER_EXEC", socket.c_str(), 1) == 0;
}

/// What the child runs, between fork and exec: this process has one thread. Returns only if
/// something fails, leaving errno.
void become(char* const* arguments, const Command& command, const std::string& socket,
            const std::optional<Cgroup>& cgroup, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it died before the line above
  if (cgroup && !cgroup->enter()) return;
  if (!settle(command, socket)) return;
  if (::isatty(STDIN_FILENO) == 1) {
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execvp(arguments[0], arguments);
}

}  // namespace

Result<pid_t> start_command(const Command& command, const std::string& socket,
                            const std::optional<Cgroup>& cgroup) {
  std::vector<char*> arguments;
  // execvp does not change what it points to.
  for (const auto& word : command.words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  // The child's errno comes through a pipe that a successful exec closes.
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    return Failure{Failure::Kind::kInvalid, std::string("pipe: ") + std::strerror(errno)};
  }
  const FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    become(arguments.data(), command, socket, cgroup, self);
    const int error = errno;
    static_cast<void>(!::write(writing.get(), &error, sizeof error));
    ::_exit(127);
  }
  ::setpgid(child, child);  // both do it, whichever is first
  writing = FileDescriptor();
  int error = 0;
  if (child > 0 && ::read(reading.get(), &error, sizeof error) <= 0) return child;
  if (child > 0) ::waitpid(child, nullptr, 0);
  return Failure{Failure::Kind::kInvalid, "cannot start '" + command.words.front() +
                                              "': " + std::strerror(child > 0 ? error : errno)};
}

}  // namespace tether::supervisor
