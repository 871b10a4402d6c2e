#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/os/temporary_folder.h>
#include <tether/scenario/target.h>

namespace tether::board {

/// A connection of OpenSSH to a board over which any number of commands run: a master process with
/// its socket in a private folder. Keys, host names and jump hosts come from the user's
/// configuration; ssh asks no questions. It ends with the object and with this process. Not
/// thread-safe.
///
/// TETHER_SSH in the environment replaces the command `ssh`; it can include options.
class SshConnection {
 public:
  /// Connects. A stop request ends waiting and the commands that run over the connection. @throws
  /// Error(kSetup) about the address, with advice.
  explicit SshConnection(const scenario::SshAddress& address, std::stop_token stop = {});

  /// The command that runs a POSIX sh on the board. The shell reads its script, the first
  /// `script_bytes` of its standard input; the rest is the input of the script. Therefore lists of
  /// processes do not show the script.
  std::vector<std::string> shell(std::size_t script_bytes) const;
  /// Runs the script on the board to its end; `input` is its standard input. A stop request ends
  /// it, unless it is part of the cleanup.
  os::Captured run(std::string_view script, Duration limit, std::string_view input = {},
                   bool is_cleanup = false) const;

  /// Why the connection has ended; none if it has not. Waits at most `limit` for its end.
  std::optional<std::string> lost(Duration limit = Duration(0));
  /// Forwards a port of the board's 127.0.0.1 to `local_port` of this machine's; returns the
  /// board's port. @throws Error(kSetup) about the address if the board does not allow it.
  std::uint16_t forward_back(std::uint16_t local_port) const;

  const scenario::SshAddress& address() const { return address_; }
  /// A folder private to this process; removed with the connection.
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  std::vector<std::string> words() const;
  void connect();

  scenario::SshAddress address_;
  std::stop_token stop_;
  os::TemporaryFolder folder_;
  std::unique_ptr<os::ChildProcess> master_;
};

/// The last line of an output of ssh, with advice.
std::string explain_ssh(const std::string& output, const scenario::SshAddress& address);

}  // namespace tether::board
