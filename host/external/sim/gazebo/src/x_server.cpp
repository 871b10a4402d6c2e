#include "x_server.h"

#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/link/server.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>

namespace tether::sim {

namespace {

constexpr const char* kProgram = "Xvfb";

void require_xvfb() try { os::find_program(kProgram); } catch (const Error&) {
  throw Error(ErrorCode::kSetup,
              "cameras in Gazebo need an X server, but Xvfb is not in PATH; run: apt-get install "
              "xvfb")
      .about(kProgram);
}

/// A counted string of an Xauthority file.
std::string counted(std::string_view text) {
  return std::string{static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 0xff)} +
         std::string(text);
}

/// An Xauthority file (XSECURITY of X.Org, libXau's Xauth) with the cookie of any display.
void write_cookie(const std::filesystem::path& file) {
  constexpr std::string_view kAnyFamily = "\xff\xff";
  std::ofstream stream(file, std::ios::binary);
  stream << kAnyFamily << counted("") << counted("") << counted("MIT-MAGIC-COOKIE-1")
         << counted(link::make_token());
  if (!stream.flush()) throw Error(ErrorCode::kSetup, file.string() + ": cannot be written");
}

}  // namespace

XServer::XServer(const std::filesystem::path& folder, const std::filesystem::path& log)
    : cookie_(folder / "cookie"), display_file_(folder / "display") {
  require_xvfb();
  write_cookie(cookie_);
  // With SIGTERM as its death signal it removes its socket and its lock in /tmp.
  process_ = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = {kProgram, "-displayfd", "1", "-screen", "0", "640x480x24",
                                     "-nolisten", "tcp", "-noreset", "-auth", cookie_.string()},
                       .environment = {},
                       .log = display_file_,
                       .errors = log,
                       .appends = true,
                       .death_signal = SIGTERM});
}

bool XServer::is_ready() {
  if (!display_.empty()) return true;
  const std::string text = os::read_whole(display_file_);
  if (text.empty() || text.back() != '\n') return false;
  display_ = ":" + os::last_line(text);
  return true;
}

os::Environment XServer::environment() const {
  return {{"DISPLAY", display_}, {"XAUTHORITY", cookie_.string()}};
}

std::optional<std::string> XServer::end() {
  if (const auto& exit = process_->poll())
    return fmt::format("the X server of Gazebo's cameras ({}) {}", kProgram, exit->description);
  return std::nullopt;
}

}  // namespace tether::sim
