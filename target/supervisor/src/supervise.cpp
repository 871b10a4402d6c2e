#include "as_is_supervisor.h"
#include "command.h"
#include "freezer.h"
#include "guardian.h"
#include "membership.h"
#include "process_tree.h"
#include "supervisor.h"
#include "waiting.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/client/exec/group_page.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/link/messages.h>
#include <tether/os/process_table.h>
#include <tether/supervisor/supervise.h>
#include <tether/supervisor/supervise_as_is.h>

// What is around the Supervisor: signals, a private folder with the sockets for the commands'
// threads, a cgroup where there is one, and the guardian that clears up. And the other end of a
// group: the process that gives a command to it.
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

/// The cgroup to use, if there is to be one.
Result<std::optional<Cgroup>> choose_cgroup(FreezerChoice choice, const Say& say) {
  if (choice == FreezerChoice::kSignal) return std::optional<Cgroup>();
  auto cgroup = Cgroup::make();
  if (cgroup) return std::optional<Cgroup>(std::move(*cgroup));
  if (choice == FreezerChoice::kCgroup) return cgroup.failure();
  say(cgroup.failure().message);
  return std::optional<Cgroup>();
}

Result<std::unique_ptr<Freezer>> make_freezer(const std::optional<Cgroup>& cgroup, pid_t guardian) {
  return cgroup ? make_cgroup_freezer(*cgroup) : make_signal_freezer(guardian);
}

/// The socket at which the members' processes give their commands; gone with the object.
class GroupSocket {
 public:
  explicit GroupSocket(std::string path) : path_(std::move(path)) {}
  ~GroupSocket() {
    if (is_there_) ::unlink(path_.c_str());
  }
  GroupSocket(const GroupSocket&) = delete;
  GroupSocket& operator=(const GroupSocket&) = delete;

  Result<os::FileDescriptor> listen() {
    auto listener = client::listen_local(path_);
    is_there_ = bool(listener);
    return listener;
  }

 private:
  std::string path_;
  bool is_there_ = false;
};

int supervise_in(Surroundings& around, const Settings& settings, const Say& say) {
  auto freezer = make_freezer(around.cgroup, around.guardian.process());
  if (!freezer) return fail(say, 3, freezer.failure().message);
  around.freezer = std::move(*freezer);
  auto clock = client::make_clock_page();
  if (!clock) return fail(say, 3, clock.failure().message);
  around.clock = std::move(*clock);

  Supervisor supervisor(settings, around, say);
  GroupSocket socket(settings.group);
  if (settings.members > 0) {
    auto listener = socket.listen();
    if (!listener) return fail(say, 3, listener.failure().message);
    supervisor.listen(std::move(*listener));
    say("stopping " + std::to_string(settings.members) + " programs together by " +
        around.freezer->name());
  } else {
    if (const Status started = supervisor.start(); !started)
      return fail(say, 2, started.failure().message);
    say("stopping the command by " + around.freezer->name());
  }
  const int exit_code = supervisor.run();
  ProcessTree(around.guardian.process()).kill_all();
  if (settings.verbose) say(supervisor.statistics());
  return exit_code;
}

/// How long the process of the group may take to start.
constexpr Duration kJoinLimit = std::chrono::seconds(10);

/// Gives the command to the group, passes signals on, and ends as the command does.
int join(const Settings& settings, const os::FileDescriptor& signals, const Say& say) {
  auto socket = client::connect_local(settings.group);
  wait_until(
      [&] {
        if (!socket) socket = client::connect_local(settings.group);
        return bool(socket);
      },
      kJoinLimit);
  if (!socket)
    return fail(say, 3, "no group at " + settings.group + ". Start it with --group and --members");
  const int group = socket->descriptor();
  if (const Status sent = send_program(group, settings.uav, settings.command); !sent)
    return fail(say, 3, sent.failure().message);
  while (true) {
    pollfd entries[] = {{signals.get(), POLLIN, 0}, {group, POLLIN, 0}};
    if (::poll(entries, 2, -1) < 0) continue;
    signalfd_siginfo info{};
    while (::read(signals.get(), &info, sizeof info) == static_cast<ssize_t>(sizeof info))
      if (info.ssi_signo != SIGCHLD) send_signal(group, static_cast<int>(info.ssi_signo));
    if (entries[1].revents == 0) continue;
    const auto end = receive_end(group);
    if (!end) return fail(say, 3, "the process of the group has ended, and the command with it");
    if (!end->message.empty()) say(end->message);
    return end->code;
  }
}

/// This thread, and all processes that it starts, on the core on which it is.
void stay_on_one_core() {
  cpu_set_t core;
  CPU_ZERO(&core);
  CPU_SET(static_cast<std::size_t>(std::max(0, ::sched_getcpu())), &core);
  ::sched_setaffinity(0, sizeof core, &core);
}

/// Of processes that find this one by their environment.
std::vector<std::string> environment_with(const std::string& library) {
  std::vector<std::string> all;
  std::string preloaded = "LD_PRELOAD=" + library;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string one = *variable;
    if (one.starts_with("LD_PRELOAD=") && one.size() > 11)
      preloaded += ":" + one.substr(11);
    else if (!one.starts_with("TETHER_TOKEN=") && !one.starts_with("TETHER_ADDRESS="))
      all.push_back(one);
  }
  all.push_back(preloaded);
  all.emplace_back("TETHER_AS_IS=group");
  return all;
}

int run_as_is(const std::vector<std::string>& command, const std::string& library,
              const std::string& folder, Guardian& guardian, const os::FileDescriptor& signals,
              const Say& say) {
  auto options = client::options_from_environment();
  if (!options) return fail(say, 2, options.failure().message);
  if (!options->exec_socket.empty() || options->time->clock().kind != computer::ClockKind::kCpu)
    return fail(say, 2,
                "--all-processes needs TETHER_CLOCK=cpu or cpu*FACTOR, and no other tether-exec "
                "around it");
  const double factor = options->time->clock().factor;
  const std::string socket = folder + "/socket";
  auto page = client::make_group_page(client::group_page_beside(socket));
  if (!page) return fail(say, 3, page.failure().message);
  auto clock = client::make_clock_page();
  if (!clock) return fail(say, 3, clock.failure().message);
  auto listener = client::listen_local(socket);
  if (!listener) return fail(say, 3, listener.failure().message);
  Callers callers(std::move(*listener), clock->descriptor);

  stay_on_one_core();
  const std::string& program_name = command.front();
  options->sut_name = program_name.substr(program_name.rfind('/') + 1);
  client::Computed computed;
  options->time = client::make_group_source(**page, factor, nullptr, &computed);
  auto vehicle = client::connect(std::move(*options));
  if (!vehicle) return fail(say, 3, vehicle.failure().message);
  ::pthread_setname_np(::pthread_self(), link::kClientThread);
  const auto program = start_command({command, environment_with(library)}, socket, std::nullopt);
  if (!program) return fail(say, 2, program.failure().message);
  guardian.watch(*program);
  (*page)->enter(*program);

  AsIsSupervisor supervisor(*program, **page, std::move(*vehicle), factor, callers,
                            {signals, guardian.process(), computed}, say);
  const auto status = supervisor.run();
  const bool has_exited = status && WIFEXITED(*status);
  if (has_exited) supervisor.finish(WEXITSTATUS(*status));
  ProcessTree(guardian.process()).kill_all();
  if (!status) return 0;
  if (has_exited) return WEXITSTATUS(*status);
  return -WTERMSIG(*status);
}

}  // namespace

int supervise_as_is(const std::vector<std::string>& command, const std::string& library,
                    const Say& say) {
  const os::FileDescriptor signals = catch_signals();
  os::adopt_orphans();
  const std::string folder = make_private_folder();
  if (folder.empty())
    return fail(say, 3, std::string("cannot create a private folder: ") + std::strerror(errno));
  int code = 0;
  {
    Guardian guardian(folder, "");
    if (!guardian.is_there()) return fail(say, 3, "cannot start the clean-up process");
    code = run_as_is(command, library, folder, guardian, signals, say);
  }
  if (code >= 0) return code;
  ::signal(-code, SIG_DFL);
  ::prctl(PR_SET_DUMPABLE, 0);  // the program has left its core file
  ::raise(-code);
  return 128 - code;
}

int supervise(const Settings& settings, const Say& say) {
  os::FileDescriptor signals = catch_signals();
  if (!settings.group.empty() && settings.members == 0) return join(settings, signals, say);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const std::string folder = make_private_folder();
  if (folder.empty())
    return fail(say, 3, std::string("cannot create a private folder: ") + std::strerror(errno));
  const auto cgroup = choose_cgroup(settings.freezer, say);
  Guardian guardian(folder, cgroup && *cgroup ? (*cgroup)->path() : "");
  if (!cgroup) return fail(say, 3, cgroup.failure().message);
  if (!guardian.is_there()) return fail(say, 3, "cannot start the clean-up process");
  Surroundings around{folder, *cgroup, guardian, std::move(signals), nullptr, {}};
  return supervise_in(around, settings, say);
}

}  // namespace tether::supervisor
