#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <tether/os/child_process.h>

namespace tether::sim {

/// An X server without a screen (Xvfb), for programs that draw: on a free display, with a local
/// socket that requires its cookie. It ends with the object, and with this process however that
/// ends. Not thread-safe.
class XServer {
 public:
  /// Starts it; `folder` is private, and gets the cookie. Its output goes to the end of `log`.
  /// @throws Error(kSetup) if there is no Xvfb, with how to install it.
  XServer(const std::filesystem::path& folder, const std::filesystem::path& log);

  /// Whether programs can connect yet.
  bool is_ready();
  /// The variables with which a program draws there. @pre is_ready().
  os::Environment environment() const;
  /// How it ended; none while it runs.
  std::optional<std::string> end();

 private:
  std::filesystem::path cookie_;
  std::filesystem::path display_file_;  // gets the display's number
  std::string display_;                 // ":7"; empty: not known yet
  std::unique_ptr<os::ChildProcess> process_;
};

}  // namespace tether::sim
