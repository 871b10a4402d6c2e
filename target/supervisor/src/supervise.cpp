#include "command.h"
#include "freezer.h"
#include "guardian.h"
#include "process_tree.h"
#include "supervisor.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>

#include <tether/supervisor/supervise.h>

// What is around the Supervisor: signals, a private folder with the socket for the command's
// threads, a cgroup where there is one, the guardian that clears up, and the command itself.
namespace tether::supervisor {
namespace {

int fail(const Say& say, int code, const std::string& message) {
  say(message);
  return code;
}

os::FileDescriptor catch_signals() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  action.sa_flags = SA_NOCLDSTOP;
  ::sigaction(SIGCHLD, &action, nullptr);
  sigset_t caught;
  ::sigemptyset(&caught);
  for (const int signal : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&caught, signal);
  ::sigprocmask(SIG_BLOCK, &caught, nullptr);
  return os::FileDescriptor(::signalfd(-1, &caught, SFD_CLOEXEC | SFD_NONBLOCK));
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
Result<std::optional<Cgroup>> choose_cgroup(FreezerChoice choice, const Say& say) {
  if (choice == FreezerChoice::kSignal) return std::optional<Cgroup>();
  auto cgroup = Cgroup::make();
  if (cgroup) return std::optional<Cgroup>(std::move(*cgroup));
  if (choice == FreezerChoice::kCgroup) return cgroup.failure();
  say(cgroup.failure().message);
  return std::optional<Cgroup>();
}

Result<std::unique_ptr<Freezer>> make_freezer(const std::optional<Cgroup>& cgroup, pid_t command,
                                              pid_t guardian) {
  return cgroup ? make_cgroup_freezer(*cgroup) : make_signal_freezer(command, guardian);
}

int supervise_in(const std::string& folder, const Settings& settings,
                 const std::optional<Cgroup>& cgroup, Guardian& guardian,
                 os::FileDescriptor signals, const Say& say) {
  auto clock = client::make_clock_page();
  if (!clock) return fail(say, 3, clock.failure().message);
  const std::string path = folder + "/socket";
  auto listener = client::listen_local(path);
  if (!listener) return fail(say, 3, listener.failure().message);
  const auto command = start_command(settings.command, path, cgroup);
  if (!command) return fail(say, 2, command.failure().message);
  guardian.watch(*command);
  auto freezer = make_freezer(cgroup, *command, guardian.process());
  if (!freezer) return fail(say, 3, freezer.failure().message);
  say("stopping the command by " + (*freezer)->name());
  const char* const priority = raise_priority();

  Supervisor supervisor(settings, *command, std::move(*clock), std::move(*listener),
                        std::move(signals), std::move(*freezer), say);
  const int exit_code = supervisor.run();
  ProcessTree(guardian.process()).kill_all();
  if (settings.verbose) say(supervisor.statistics() + "  with " + priority);
  return exit_code;
}

}  // namespace

int supervise(const Settings& settings, const Say& say) {
  os::FileDescriptor signals = catch_signals();
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const std::string folder = make_private_folder();
  if (folder.empty())
    return fail(say, 3, std::string("cannot create a private folder: ") + std::strerror(errno));
  const auto cgroup = choose_cgroup(settings.freezer, say);
  Guardian guardian(folder, cgroup && *cgroup ? (*cgroup)->path() : "");
  if (!cgroup) return fail(say, 3, cgroup.failure().message);
  if (!guardian.is_there()) return fail(say, 3, "cannot start the clean-up process");
  return supervise_in(folder, settings, *cgroup, guardian, std::move(signals), say);
}

}  // namespace tether::supervisor
