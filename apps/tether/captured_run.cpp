#include "captured_run.h"

#include "child_process.h"
#include "interrupt.h"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>

namespace tether::app {

namespace {

using Steady = std::chrono::steady_clock;
constexpr Duration kLook = std::chrono::milliseconds(20);

/// A file in memory: a killed run leaves nothing of it, whatever it holds.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("tether", MFD_CLOEXEC)) {
    if (fd_ < 0)
      throw Error(ErrorCode::kSetup, "no file can be made in memory: " + reason_of(errno));
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  /// For whoever is in this process.
  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", fd_); }

 private:
  int fd_;
};

void write_whole(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.flush())
    throw Error(ErrorCode::kSetup, "no copy can be made in memory: " + reason_of(errno));
}

std::string stripped(const std::string& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  const auto end = line.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
}

}  // namespace

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (const std::string words = stripped(line); !words.empty()) last = words;
  return last;
}

Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, bool is_leaving) {
  const MemoryFile in, out, err;
  write_whole(in.path(), input);
  const auto started = Steady::now();
  Captured captured;
  {
    ChildProcess process({.arguments = arguments,
                          .environment = {},
                          .log = out.path(),
                          .errors = err.path(),
                          .input = in.path()});
    while (!process.wait(kLook) && (is_leaving || !interrupted()) &&
           Steady::now() - started < limit)
      continue;
    captured.wall = std::chrono::duration_cast<Duration>(Steady::now() - started);
    captured.timed_out = !process.poll();
    if (process.poll()) captured.code = process.poll()->code;
  }
  captured.out = read_whole(out.path());
  captured.err = read_whole(err.path());
  return captured;
}

}  // namespace tether::app
