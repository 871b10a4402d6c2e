#include "process.h"

#include "files.h"

#include <csignal>
#include <thread>

namespace tether::system_test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(5);

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

Command with(Command command, const std::vector<std::string>& arguments,
             const Variables& environment) {
  append(command.arguments, arguments);
  append(command.environment, environment);
  return command;
}
Command started_by(const std::vector<std::string>& launcher, Command command) {
  command.arguments.insert(command.arguments.begin(), launcher.begin(), launcher.end());
  return command;
}

Process::Process(const Command& command)
    : child_({.arguments = command.arguments,
              .environment = command.environment,
              .log = folder_.path("out"),
              .errors = folder_.path("err"),
              .input_pipe = input_.read_end.get(),
              .working_folder = command.working_folder}) {
  input_.read_end = {};
}
Process::~Process() {
  kill(-pid(), SIGKILL);
}

std::string Process::out() const {
  return read_text(folder_.path("out"));
}
std::string Process::err() const {
  return read_text(folder_.path("err"));
}
void Process::signal(int number) const {
  kill(pid(), number);
}

Output Process::wait(std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + limit;
  while (!has_ended() && Clock::now() < deadline) std::this_thread::sleep_for(kPoll);
  Output output;
  output.wall = Clock::now() - started_;
  output.timed_out = !has_ended();
  if (output.timed_out) kill(-pid(), SIGKILL);
  child_.wait(std::chrono::seconds(10));
  output.code = child_.poll().value().code;
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
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    // Empty for a zombie, and for processes of others.
    const std::string environment = '\0' + read_text(entry.path() / "environ");
    if (environment.find('\0' + wanted) != std::string::npos) found.push_back(std::stoi(name));
  }
  return found;
}

bool wait_until(const std::function<bool()>& holds, std::chrono::duration<double> limit) {
  const auto deadline = Clock::now() + limit;
  while (!holds()) {
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}
bool wait_until_gone(const std::string& mark, std::chrono::duration<double> limit) {
  return wait_until([&] { return processes_with_mark(mark).empty(); }, limit);
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
