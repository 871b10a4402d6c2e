#include "command.h"
#include "command_line.h"
#include "guardian.h"
#include "process_tree.h"
#include "supervisor.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <utility>

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>

namespace tether::exec {
namespace {

int fail(int code, const std::string& message) {
  std::fprintf(stderr, "tether-exec: %s\n", message.c_str());
  return code;
}

client::FileDescriptor catch_signals() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  action.sa_flags = SA_NOCLDSTOP;
  ::sigaction(SIGCHLD, &action, nullptr);
  sigset_t caught;
  ::sigemptyset(&caught);
  for (const int signal : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&caught, signal);
  ::sigprocmask(SIG_BLOCK, &caught, nullptr);
  return client::FileDescriptor(::signalfd(-1, &caught, SFD_CLOEXEC | SFD_NONBLOCK));
}

/// A folder that only this user can enter; empty: there cannot be one.
std::string make_private_folder() {
  const char* const base = std::getenv("TMPDIR");
  std::string path =
      std::string(base == nullptr || *base == '\0' ? "/tmp" : base) + "/tether-exec-XXXXXX";
  return ::mkdtemp(path.data()) == nullptr ? "" : path;
}

/// Before the command's threads, so that a stop comes when it is due. Returns what was allowed.
const char* raise_priority() {
  ::prctl(PR_SET_TIMERSLACK, 1);
  sched_param parameters{};
  parameters.sched_priority = 1;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) return "real-time priority";
  if (::setpriority(PRIO_PROCESS, 0, -20) == 0) return "nice -20";
  return "ordinary priority (neither SCHED_FIFO nor a nice below 0 is allowed)";
}

/// The cgroup to use, if there is to be one.
Result<std::optional<Cgroup>> choose_cgroup(FreezerChoice choice) {
  if (choice == FreezerChoice::kSignal) return std::optional<Cgroup>();
  auto cgroup = Cgroup::make();
  if (cgroup) return std::optional<Cgroup>(std::move(*cgroup));
  if (choice == FreezerChoice::kCgroup) return cgroup.failure();
  std::fprintf(stderr, "tether-exec: %s\n", cgroup.failure().message.c_str());
  return std::optional<Cgroup>();
}

Result<std::unique_ptr<Freezer>> make_freezer(const std::optional<Cgroup>& cgroup, pid_t command,
                                              pid_t guardian) {
  return cgroup ? make_cgroup_freezer(*cgroup) : make_signal_freezer(command, guardian);
}

int supervise(const Settings& settings, const std::string& folder,
              const std::optional<Cgroup>& cgroup, Guardian& guardian,
              client::FileDescriptor signals) {
  auto clock = client::make_clock_page();
  if (!clock) return fail(3, clock.failure().message);
  const std::string path = folder + "/socket";
  auto listener = client::listen_local(path);
  if (!listener) return fail(3, listener.failure().message);
  const auto command = start_command(settings.command, path, cgroup);
  if (!command) return fail(2, command.failure().message);
  guardian.watch(*command);
  auto freezer = make_freezer(cgroup, *command, guardian.process());
  if (!freezer) return fail(3, freezer.failure().message);
  std::fprintf(stderr, "tether-exec: stops the command by %s\n", (*freezer)->name().c_str());
  const char* const priority = raise_priority();

  Supervisor supervisor(settings, *command, std::move(*clock), std::move(*listener),
                        std::move(signals), std::move(*freezer));
  const int exit_code = supervisor.run();
  ProcessTree(guardian.process()).kill_all();
  if (settings.verbose) {
    std::fprintf(stderr, "%s  with %s\n", supervisor.statistics().c_str(), priority);
  }
  return exit_code;
}

int run(Settings settings) {
  if (const Status good = read_environment(settings); !good) return fail(2, good.failure().message);
  client::FileDescriptor signals = catch_signals();
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const std::string folder = make_private_folder();
  if (folder.empty()) return fail(3, std::string("no private folder: ") + std::strerror(errno));
  const auto cgroup = choose_cgroup(settings.freezer);
  Guardian guardian(folder, cgroup && *cgroup ? (*cgroup)->path() : "");
  if (!cgroup) return fail(3, cgroup.failure().message);
  if (!guardian.is_there()) return fail(3, "the process that clears up cannot be started");
  return supervise(settings, folder, *cgroup, guardian, std::move(signals));
}

int main_of(const std::vector<std::string>& arguments) {
  Parsed parsed = parse_command_line(arguments);
  if (!parsed.notice) return run(std::move(parsed.settings));
  std::fputs(parsed.notice->text.c_str(), parsed.notice->exit_code == 0 ? stdout : stderr);
  return parsed.notice->exit_code;
}

}  // namespace
}  // namespace tether::exec

int main(int argc, char** argv) {
  try {
    return tether::exec::main_of({argv + 1, argv + argc});
  } catch (const std::exception& error) {  // the standard library's: no memory
    std::fprintf(stderr, "tether-exec: %s\n", error.what());
    return 3;
  }
}
