#include "svg.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>
#include <tether/report/gnuplot.h>

extern char** environ;

namespace tether::report {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::kSetup, what);
}

// A file in memory. Unlike pipes, the two ends never wait for each other.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("tether-plot", MFD_CLOEXEC)) {
    if (fd_ < 0) fail(fmt::format("no memory file for a plot: {}", reason_of(errno)));
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int fd() const { return fd_; }

  void fill(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
      const auto written = write(fd_, text.data() + done, text.size() - done);
      if (written < 0) fail(fmt::format("cannot hold a plot: {}", reason_of(errno)));
      done += static_cast<std::size_t>(written);
    }
    lseek(fd_, 0, SEEK_SET);
  }

  std::string content() const {
    lseek(fd_, 0, SEEK_SET);
    std::string text;
    char buffer[65536];
    for (ssize_t n = 0; (n = read(fd_, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(n));
    return text;
  }

 private:
  int fd_;
};

pid_t start(const std::string& program, const MemoryFile& in, const MemoryFile& out,
            const MemoryFile& err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.fd(), STDERR_FILENO);
  std::string name = program, no_user_settings = "-d";
  char* arguments[] = {name.data(), no_user_settings.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT)
    fail(
        fmt::format("'{}' is not installed, and draws the plots; on Debian: apt-get install "
                    "gnuplot-nox",
                    program));
  if (error != 0) fail(fmt::format("'{}' cannot be started: {}", program, reason_of(error)));
  return child;
}

// What went wrong with its end; empty where nothing did.
std::string failure_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return reason_of(errno);
  }
  if (WIFSIGNALED(status)) return "ended by " + name_of_signal(WTERMSIG(status));
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));
}

std::string first_words(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return "";
  std::string words = text.substr(begin, 300);
  for (char& c : words) c = c == '\n' || c == '\r' ? ' ' : c;
  return words;
}

}  // namespace

std::string draw_svg(const Plot& plot, const std::string& program) {
  const MemoryFile in, out, err;
  in.fill(plot.script);
  std::string failure = failure_of(start(program, in, out, err));
  if (failure.empty()) {
    if (const auto svg = finished_svg(out.content(), plot.title)) return *svg;
    failure = "no whole picture";
  }
  const std::string said = first_words(err.content());
  fail(fmt::format("'{}' could not draw \"{}\": {}", program, plot.title,
                   said.empty() ? failure : said));
}

}  // namespace tether::report
