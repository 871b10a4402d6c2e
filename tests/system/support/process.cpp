#include "process.h"

#include "files.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tether::system_test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(5);

std::vector<std::string> merged_environment(const Command& command) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    const auto equals = text.find('=');
    if (equals != std::string::npos) variables[text.substr(0, equals)] = text.substr(equals + 1);
  }
  for (const auto& [name, value] : command.environment) variables[name] = value;
  std::vector<std::string> list;
  for (const auto& [name, value] : variables) list.push_back(name + "=" + value);
  return list;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& text : strings) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

struct Streams {
  int in, out, err;
};

[[noreturn]] void become(char* const* arguments, char* const* environment, const char* folder,
                         const Streams& streams) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing running
  dup2(streams.in, STDIN_FILENO);
  dup2(streams.out, STDOUT_FILENO);
  dup2(streams.err, STDERR_FILENO);
  if (*folder != '\0' && chdir(folder) != 0) _exit(126);
  environ = const_cast<char**>(environment);
  execvp(arguments[0], arguments);
  _exit(127);
}

int open_new(const std::filesystem::path& file) {
  return open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
}

}  // namespace

Process::Process(const Command& command) : started_(Clock::now()) {
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = merged_environment(command);
  const std::vector<char*> argv = pointers(arguments);
  const std::vector<char*> envp = pointers(environment);
  int in[2];
  if (pipe2(in, O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  stdin_ = in[1];
  const Streams streams{in[0], open_new(folder_.path("out")), open_new(folder_.path("err"))};
  pid_ = fork();
  if (pid_ == 0) become(argv.data(), envp.data(), command.working_folder.c_str(), streams);
  for (const int fd : {streams.in, streams.out, streams.err}) close(fd);
  if (pid_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  setpgid(pid_, pid_);  // whichever of the two comes first
}

Process::~Process() {
  kill(-pid_, SIGKILL);
  if (!status_) waitpid(pid_, nullptr, 0);
  close(stdin_);
}

std::string Process::out() const {
  return read_text(folder_.path("out"));
}
std::string Process::err() const {
  return read_text(folder_.path("err"));
}
void Process::signal(int number) const {
  kill(pid_, number);
}

bool Process::has_ended() {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  return status_.has_value();
}

Output Process::wait(std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + limit;
  while (!has_ended() && Clock::now() < deadline) std::this_thread::sleep_for(kPoll);
  Output output;
  output.wall = Clock::now() - started_;
  output.timed_out = !status_.has_value();
  if (output.timed_out) {
    kill(-pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    status_ = status;
  }
  output.code = WIFSIGNALED(*status_) ? 128 + WTERMSIG(*status_) : WEXITSTATUS(*status_);
  output.out = out();
  output.err = err();
  return output;
}

bool Process::wait_for(const std::filesystem::path& file, const std::string& text,
                       std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + limit;
  while (true) {
    const bool last_look = has_ended() || Clock::now() >= deadline;
    if (read_text(file).find(text) != std::string::npos) return true;
    if (last_look) return false;
    std::this_thread::sleep_for(kPoll);
  }
}
bool Process::wait_for_err(const std::string& text, std::chrono::duration<double> limit) {
  return wait_for(folder_.path("err"), text, limit);
}
bool Process::wait_for_out(const std::string& text, std::chrono::duration<double> limit) {
  return wait_for(folder_.path("out"), text, limit);
}

Output run(const Command& command, std::chrono::duration<double> limit) {
  return Process(command).wait(limit);
}

std::vector<pid_t> processes_with_mark(const std::string& mark) {
  const std::string wanted = std::string("TETHER_TEST_MARK=") + mark + '\0';
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; }))
      continue;
    // Empty for a zombie, and for processes of others.
    const std::string environment = '\0' + read_text(entry.path() / "environ");
    if (environment.find('\0' + wanted) != std::string::npos) found.push_back(std::stoi(name));
  }
  return found;
}

bool wait_until_gone(const std::string& mark, std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + limit;
  while (!processes_with_mark(mark).empty()) {
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

std::filesystem::path tether_program() {
  return TETHER_PROGRAM;
}
std::filesystem::path sut_program() {
  return TETHER_SUT_PROGRAM;
}
std::filesystem::path bad_sut_program() {
  return BAD_SUT_PROGRAM;
}

std::filesystem::path stand_in_program() {
  return STAND_IN_PROGRAM;
}
std::filesystem::path proxy_program() {
  return LINK_PROXY_PROGRAM;
}

}  // namespace tether::system_test
