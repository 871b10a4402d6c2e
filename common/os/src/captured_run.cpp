#include <chrono>

#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>

namespace tether::os {

namespace {

using Steady = std::chrono::steady_clock;
constexpr Duration kLook = std::chrono::milliseconds(20);

}  // namespace

Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, const std::stop_token& stop) {
  const MemoryFile in(input), out, err;
  const auto started = Steady::now();
  Captured captured;
  {
    ChildProcess process({.arguments = arguments,
                          .environment = {},
                          .log = out.path(),
                          .errors = err.path(),
                          .input = in.path()});
    while (!process.wait(kLook) && !stop.stop_requested() && Steady::now() - started < limit)
      continue;
    captured.wall = std::chrono::duration_cast<Duration>(Steady::now() - started);
    captured.timed_out = !process.poll();
    if (process.poll()) captured.code = process.poll()->code;
  }
  captured.out = out.content();
  captured.err = err.content();
  return captured;
}

}  // namespace tether::os
