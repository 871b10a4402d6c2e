#include "plots/svg.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/report/plots.h>

namespace tether::report {
namespace {

// A plot takes gnuplot less than a second, and the sanitizers some more.
constexpr Duration kLimit = std::chrono::minutes(2);

std::filesystem::path find_gnuplot(const std::string& name) {
  try {
    return os::find_program(name);
  } catch (const Error&) {
    throw Error(ErrorCode::kSetup, fmt::format("'{}' is not installed, but the plots need it. On "
                                               "Debian, run: apt-get install gnuplot-nox",
                                               name))
        .about(name);
  }
}

// The start of what the program wrote to stderr, on one line; else how it ended.
std::string reason_of(const os::Captured& run) {
  constexpr std::size_t kShown = 300;
  const auto begin = run.err.find_first_not_of(" \t\r\n");
  if (begin != std::string::npos) {
    std::string words = run.err.substr(begin, kShown);
    std::ranges::replace_if(
        words, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return words;
  }
  if (run.timed_out) return "timed out";
  if (run.code > os::kSignalled) return "ended by " + name_of_signal(run.code - os::kSignalled);
  return run.code == 0 ? "incomplete SVG" : fmt::format("exit code {}", run.code);
}

}  // namespace

std::string draw_svg(const Plot& plot, const std::string& program) {
  // Option -d: without the user's settings.
  const os::Captured run =
      os::run_captured({find_gnuplot(program).string(), "-d"}, plot.script, kLimit);
  if (run.code == 0) {
    if (const auto svg = finished_svg(run.out, plot.title)) return *svg;
  }
  throw Error(ErrorCode::kSetup,
              fmt::format("'{}' cannot draw \"{}\": {}", program, plot.title, reason_of(run)))
      .about(plot.title);
}

}  // namespace tether::report
