#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <tether/os/captured_run.h>
#include <tether/os/child_process.h>
#include <tether/scenario/target.h>

namespace tether::board {

/// One connection of OpenSSH to a board, over which any number of commands run: a master of its own
/// with its socket in a private folder. Keys, names and jump hosts are those of the user's
/// configuration; no question is ever asked. It ends with the object, and with this process however
/// that ends. Not thread-safe.
///
/// TETHER_SSH in the environment is the command to use for `ssh`, with its first options.
class SshConnection {
 public:
  /// Connects. Once a stop is requested, that and what runs over it ends. @throws Error(kSetup)
  /// saying why that failed and what to do.
  explicit SshConnection(const scenario::SshAddress& address, std::stop_token stop = {});
  ~SshConnection();
  SshConnection(const SshConnection&) = delete;
  SshConnection& operator=(const SshConnection&) = delete;

  /// What runs a POSIX sh on the board that reads its own script, `script_bytes` long, from the
  /// front of its standard input; the rest is the script's. So nothing of the script is seen in a
  /// list of processes.
  std::vector<std::string> shell(std::size_t script_bytes) const;
  /// Runs the script there to its end; `input` is its standard input.
  /// What is part of leaving goes on when a stop is requested.
  os::Captured run(std::string_view script, Duration limit, std::string_view input = {},
                   bool is_leaving = false) const;

  /// Why it has ended; none while it stands. Waits at most `limit` for that to show.
  std::optional<std::string> lost(Duration limit = Duration(0));
  /// A port of the board's loopback whose connections come out at that port of this machine's.
  /// @throws Error(kSetup) when the board does not allow it.
  std::uint16_t forward_back(std::uint16_t local_port) const;

  const scenario::SshAddress& address() const { return address_; }
  /// Private to this process; goes with the connection.
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::vector<std::string> words() const;
  void connect();

  scenario::SshAddress address_;
  std::stop_token stop_;
  std::filesystem::path folder_;
  std::unique_ptr<os::ChildProcess> master_;
};

/// One line of what ssh said, with what to do about it.
std::string explain_ssh(const std::string& said, const scenario::SshAddress& address);

}  // namespace tether::board
