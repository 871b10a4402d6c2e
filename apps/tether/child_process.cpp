#include "child_process.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <map>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>

extern char** environ;

namespace tether::app {

namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(5);

bool is_program(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

std::vector<std::string> merged_environment(
    const std::vector<std::pair<std::string, std::string>>& extra) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    const auto equals = text.find('=');
    if (equals != std::string::npos) variables[text.substr(0, equals)] = text.substr(equals + 1);
  }
  for (const auto& [name, value] : extra) variables[name] = value;
  std::vector<std::string> list;
  for (const auto& [name, value] : variables) list.push_back(name + "=" + value);
  return list;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& s : strings) list.push_back(s.data());
  list.push_back(nullptr);
  return list;
}

int open_log(const std::filesystem::path& log, bool appends) {
  const std::filesystem::path file = log.empty() ? "/dev/null" : log;
  const int how = appends ? O_APPEND : O_TRUNC;
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0644);
  if (fd < 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("{}: cannot be opened: {}", file.string(), reason_of(errno)));
  return fd;
}

cpu_set_t to_set(const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<std::size_t>(cpu), &set);
  return set;
}

int open_input(const std::filesystem::path& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("{}: cannot be opened: {}", file.string(), reason_of(errno)));
  return fd;
}

/// One's own, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// A child's standard streams; an input of -1 is /dev/null.
class Streams {
 public:
  explicit Streams(const ChildCommand& command)
      : pipe_(command.input_pipe),
        input_(command.input.empty() ? -1 : open_input(command.input)),
        log_(open_log(command.log, command.appends)),
        errors_(command.errors.empty() ? -1 : open_log(command.errors, command.appends)) {}

  int in() const { return input_.get() < 0 ? pipe_ : input_.get(); }
  int out() const { return log_.get(); }
  int err() const { return errors_.get() < 0 ? log_.get() : errors_.get(); }

 private:
  int pipe_;
  Descriptor input_, log_, errors_;
};

/// What a child becomes; made before the fork.
struct Image {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* working_folder;  // nullptr: as it is
  const cpu_set_t* cpus;       // nullptr: all
  int death_signal;
};

// Between fork and exec only calls that are safe after a fork of a program with threads. Tells
// `report` why it failed.
[[noreturn]] void become(const Image& image, const Streams& streams, int report, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, image.death_signal);
  if (getppid() != parent) _exit(127);
  dup2(streams.in() < 0 ? open("/dev/null", O_RDONLY) : streams.in(), STDIN_FILENO);
  dup2(streams.out(), STDOUT_FILENO);
  dup2(streams.err(), STDERR_FILENO);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGXFSZ, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const bool is_placed =
      (!image.cpus || sched_setaffinity(0, sizeof *image.cpus, image.cpus) == 0) &&
      (!image.working_folder || chdir(image.working_folder) == 0);
  if (is_placed) execve(image.program, image.arguments, image.environment);
  const int why = errno;
  const auto written = write(report, &why, sizeof why);
  _exit(written == sizeof why ? 127 : 126);
}

}  // namespace

std::vector<int> allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) cpus.push_back(cpu);
  return cpus;
}

std::filesystem::path own_file() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

std::filesystem::path find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (is_program(name)) return name;
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot start \"{}\": no such program, or not executable", name));
  }
  std::vector<std::filesystem::path> folders{own_file().parent_path()};
  const char* path = std::getenv("PATH");
  std::istringstream list(path ? path : "");
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  for (const auto& folder : folders)
    if (is_program(folder / name)) return folder / name;
  throw Error(ErrorCode::kSetup, fmt::format("cannot start \"{}\": it is neither in {} nor in PATH",
                                             name, own_file().parent_path().string()));
}

ChildProcess::ChildProcess(const ChildCommand& command)
    : program_(find_program(command.arguments.at(0)).string()),
      end_signal_(command.end_signal),
      grace_(command.grace) {
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = merged_environment(command.environment);
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  const cpu_set_t cpus = to_set(command.cpus);
  const Streams streams(command);
  int report[2];
  if (pipe2(report, O_CLOEXEC) != 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot start \"{}\": {}", program_, reason_of(errno)));

  const Image image{program_.c_str(),
                    argv.data(),
                    envp.data(),
                    command.working_folder.empty() ? nullptr : command.working_folder.c_str(),
                    command.cpus.empty() ? nullptr : &cpus,
                    command.death_signal};
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(image, streams, report[1], parent);
  close(report[1]);
  int why = pid_ < 0 ? errno : 0;
  // Ends with nothing read once the exec has succeeded.
  if (pid_ > 0 && read(report[0], &why, sizeof why) > 0) waitpid(pid_, nullptr, 0);
  close(report[0]);
  if (why != 0) {
    pid_ = -1;
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot start \"{}\": {}", program_, reason_of(why)));
  }
}

ChildProcess::~ChildProcess() {
  terminate();
}

// Shells, launchers and tether-exec tell by such a code that a signal ended their program.
void ChildProcess::reap(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    exit_ = {kSignalled + signal, "was ended by " + name_of_signal(signal)};
    return;
  }
  const int code = WEXITSTATUS(status);
  const int signal = code - kSignalled;
  const bool tells_of_signal = signal > 0 && signal < NSIG;
  exit_ = {code, fmt::format("exited with code {}{}", code,
                             tells_of_signal ? ", as after " + name_of_signal(signal) : "")};
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

}  // namespace tether::app
