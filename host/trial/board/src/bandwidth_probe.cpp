#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <tether/board/target_probe.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>

namespace tether::board {

namespace {

using Steady = std::chrono::steady_clock;

constexpr int kRoundTrips = 40;
constexpr std::size_t kBytes = 8u << 20;
constexpr Duration kTransferLimit = std::chrono::seconds(20);
constexpr Duration kEchoLimit = std::chrono::seconds(10);

double seconds_since(Steady::time_point start) {
  return std::chrono::duration<double>(Steady::now() - start).count();
}

/// Waits until the file has at least that size.
bool wait_for_size(const std::filesystem::path& file, std::uintmax_t size) {
  const auto start = Steady::now();
  std::error_code ignored;
  while (seconds_since(start) < to_seconds(kEchoLimit)) {
    if (std::filesystem::file_size(file, ignored) >= size) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return false;
}

std::optional<double> median_round_trip(const SshConnection& connection) {
  const std::string script = "exec cat";
  const os::Pipe pipe = os::make_pipe();
  const auto echo = connection.folder() / "echo";
  os::ChildProcess process({.arguments = connection.shell(script.size()),
                            .environment = {},
                            .log = echo,
                            .errors = connection.folder() / "echo.err",
                            .input_pipe = pipe.read_end.get()});
  if (!os::write_all(pipe.write_end, script)) return std::nullopt;
  std::vector<double> times;
  for (int i = 0; i <= kRoundTrips; ++i) {
    const auto start = Steady::now();
    if (!os::write_all(pipe.write_end, "x") ||
        !wait_for_size(echo, static_cast<std::uintmax_t>(i) + 1))
      return std::nullopt;
    if (i > 0) times.push_back(seconds_since(start));  // the first one waits for the shell
  }
  std::ranges::sort(times);
  return times[times.size() / 2];
}

}  // namespace

std::optional<Bandwidth> probe_bandwidth(const SshConnection& connection) {
  const auto round_trip = median_round_trip(connection);
  if (!round_trip) return std::nullopt;
  // The time of an empty transfer is not that of the bytes.
  const std::string script = "exec cat >/dev/null";
  const os::Captured nothing = connection.run(script, kTransferLimit);
  const os::Captured bytes = connection.run(script, kTransferLimit, std::string(kBytes, 'x'));
  const double time_s = to_seconds(bytes.wall - nothing.wall);
  if (nothing.code != 0 || bytes.code != 0) return std::nullopt;
  return Bandwidth{*round_trip, static_cast<double>(kBytes) / 1e6 / std::max(time_s, 1e-3)};
}

}  // namespace tether::board
