#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/interrupt.h>
#include <tether/os/process_table.h>

extern char** environ;

/// Everything that a child needs is prepared before the fork; between fork and exec it only makes
/// system calls. It reports through a pipe why it could not become the program: the pipe closes
/// without a report when the exec succeeds.
namespace tether::os {

namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(5);
constexpr auto kOrphanLimit = std::chrono::seconds(5);

/// The children that are no orphans. Locked from before a fork until its child is in it.
struct Started {
  std::mutex mutex;
  std::set<pid_t> processes;
};
Started& started() {
  static Started all;
  return all;
}

std::vector<std::string> texts_of(const Environment& environment) {
  std::vector<std::string> list;
  for (const auto& [name, value] : environment) list.push_back(name + "=" + value);
  return list;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& s : strings) list.push_back(s.data());
  list.push_back(nullptr);
  return list;
}

FileDescriptor open_file(const std::filesystem::path& file, int how) {
  FileDescriptor descriptor(open(file.c_str(), how | O_CLOEXEC, 0644));
  if (!descriptor)
    throw Error(ErrorCode::kSetup, {file.string()}, "cannot be opened: " + reason_of(errno));
  return descriptor;
}

FileDescriptor open_log(const std::filesystem::path& log, bool appends) {
  return open_file(log.empty() ? "/dev/null" : log,
                   O_WRONLY | O_CREAT | (appends ? O_APPEND : O_TRUNC));
}

cpu_set_t to_set(const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<std::size_t>(cpu), &set);
  return set;
}

/// A child's standard streams; an input of -1 is /dev/null.
class Streams {
 public:
  explicit Streams(const ChildCommand& command)
      : pipe_(command.input_pipe),
        input_(command.input.empty() ? FileDescriptor() : open_file(command.input, O_RDONLY)),
        log_(open_log(command.log, command.appends)),
        errors_(command.errors.empty() ? FileDescriptor()
                                       : open_log(command.errors, command.appends)) {}

  int in() const { return input_.get() < 0 ? pipe_ : input_.get(); }
  int out() const { return log_.get(); }
  int err() const { return errors_.get() < 0 ? log_.get() : errors_.get(); }

 private:
  int pipe_;
  FileDescriptor input_, log_, errors_;
};

bool is_script(const std::string& program) {
  std::ifstream file(program, std::ios::binary);
  return file.get() == '#' && file.get() == '!';
}

Error cannot_start(const std::string& program, int why) {
  std::string advice;
  if (why == ENOEXEC)
    advice =
        ". It is not a program for this machine: build it for the architecture that `uname -m` "
        "prints. A script must begin with #! and its interpreter";
  else if (why == ENOENT && is_script(program))
    advice = ". The interpreter in its first line is missing";
  return Error(ErrorCode::kSetup, "cannot start \"" + program + "\": " + reason_of(why) + advice)
      .about(program);
}

/// What a child becomes.
struct Image {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* working_folder;  // nullptr: as it is
  const cpu_set_t* cpus;       // nullptr: all
  int death_signal;
  bool adopts_orphans;
  const std::function<int()>& body;
};

void forget(pid_t process) {
  const std::lock_guard lock(started().mutex);
  started().processes.erase(process);
}

std::vector<pid_t> orphans() {
  const std::lock_guard lock(started().mutex);
  std::vector<pid_t> found = children_of(getpid());
  std::erase_if(found, [](pid_t child) { return started().processes.contains(child); });
  return found;
}

// As exec does.
void forget_handlers() {
  for (int number = 1; number < NSIG; ++number) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      signal(number, SIG_DFL);
  }
}

// What is the parent's alone: its handlers, its lock, which is held during the fork, its children.
[[noreturn]] void call(const Image& image, int report) {
  forget_handlers();
  close(report);
  started().processes.clear();
  started().mutex.unlock();
  prctl(PR_SET_NAME, image.program);
  std::exit(image.body());
}

// Only makes calls that are safe after the fork of a program with threads. Writes to `report` why
// it failed.
[[noreturn]] void become(const Image& image, const Streams& streams, int report, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, image.death_signal);
  if (image.adopts_orphans) prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (getppid() != parent) _exit(127);
  dup2(streams.in() < 0 ? open("/dev/null", O_RDONLY) : streams.in(), STDIN_FILENO);
  dup2(streams.out(), STDOUT_FILENO);
  dup2(streams.err(), STDERR_FILENO);
  for (const int own : {SIGPIPE, SIGXFSZ, SIGCHLD}) signal(own, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (image.body) call(image, report);
  const bool is_placed =
      (!image.cpus || sched_setaffinity(0, sizeof *image.cpus, image.cpus) == 0) &&
      (!image.working_folder || chdir(image.working_folder) == 0);
  if (is_placed) execve(image.program, image.arguments, image.environment);
  const int why = errno;
  const auto written = write(report, &why, sizeof why);
  _exit(written == sizeof why ? 127 : 126);
}

}  // namespace

Environment merged_environment(const Environment& extra) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    const auto equals = text.find('=');
    if (equals != std::string::npos) variables[text.substr(0, equals)] = text.substr(equals + 1);
  }
  for (const auto& [name, value] : extra) variables[name] = value;
  return {variables.begin(), variables.end()};
}

ChildProcess::ChildProcess(const ChildCommand& command)
    : program_(command.body ? command.arguments.at(0)
                            : find_program(command.arguments.at(0)).string()),
      end_signal_(command.end_signal),
      grace_(command.grace) {
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = texts_of(merged_environment(command.environment));
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  const cpu_set_t cpus = to_set(command.cpus);
  const Streams streams(command);
  Pipe report = make_pipe();
  if (!report.read_end) throw cannot_start(program_, errno);

  const Image image{program_.c_str(),
                    argv.data(),
                    envp.data(),
                    command.working_folder.empty() ? nullptr : command.working_folder.c_str(),
                    command.cpus.empty() ? nullptr : &cpus,
                    command.death_signal,
                    command.adopts_orphans,
                    command.body};
  const pid_t parent = getpid();
  std::optional<Interrupt::Pause> alone;
  if (command.body) {
    alone.emplace();
    std::fflush(stdout);  // or the copy writes the same again
  }
  {
    const std::lock_guard lock(started().mutex);
    pid_ = fork();
    if (pid_ == 0) become(image, streams, report.write_end.get(), parent);
    if (pid_ > 0) started().processes.insert(pid_);
  }
  alone.reset();
  report.write_end = FileDescriptor();
  int why = pid_ < 0 ? errno : 0;
  // Nothing can be read once the exec has succeeded.
  if (pid_ > 0 && read(report.read_end.get(), &why, sizeof why) > 0) {
    waitpid(pid_, nullptr, 0);
    forget(pid_);
  }
  if (why != 0) {
    pid_ = -1;
    throw cannot_start(program_, why);
  }
}

ChildProcess::~ChildProcess() {
  terminate();
}

// Shells, launchers and tether-exec report by such a code that a signal ended their program.
void ChildProcess::reap(int status) {
  forget(pid_);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    exit_ = {kSignalled + signal, "was ended by " + name_of_signal(signal)};
    return;
  }
  const int code = WEXITSTATUS(status);
  const int signal = code - kSignalled;
  const bool reports_signal = signal > 0 && signal < NSIG;
  exit_ = {code, "exited with code " + std::to_string(code) +
                     (reports_signal ? ", as after " + name_of_signal(signal) : "")};
}

const std::optional<ChildExit>& ChildProcess::poll() {
  int status = 0;
  if (!exit_ && pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) reap(status);
  return exit_;
}

bool ChildProcess::wait(Duration limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!poll() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(kPollPeriod);
  return exit_.has_value();
}

void ChildProcess::terminate() {
  if (pid_ < 0) return;
  if (!poll()) {
    kill(-pid_, end_signal_);
    kill(-pid_, SIGCONT);
    wait(grace_);
  }
  kill(-pid_, SIGKILL);  // what is left of its group
  int status = 0;
  if (!exit_ && waitpid(pid_, &status, 0) == pid_) reap(status);
  pid_ = -1;
}

// tether-exec's guardian, an orphan if tether-exec was killed, blocks SIGTERM and ends by itself.
void end_orphans(Duration grace) {
  const auto began = std::chrono::steady_clock::now();
  std::set<pid_t> asked;
  for (auto left = orphans(); !left.empty(); left = orphans()) {
    const auto passed = std::chrono::steady_clock::now() - began;
    if (passed > grace + kOrphanLimit) return;
    for (const pid_t orphan : left) {
      if (passed >= grace) kill(orphan, SIGKILL);
      if (asked.insert(orphan).second) {
        kill(orphan, SIGTERM);
        kill(orphan, SIGCONT);
      }
      waitpid(orphan, nullptr, WNOHANG);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace tether::os
