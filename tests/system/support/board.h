#pragma once

#include "files.h"
#include "process.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tether::system_test {

/// A board that is this machine: an `sshd` of its own on a loopback port, as the present user, with
/// keys and settings in a scratch folder. Its sessions carry TETHER_TEST_MARK = `mark`, so that
/// nothing that a run leaves on the board can hide, and a lock of their own. Nothing of the user's
/// SSH settings is read or written. Ends with the object, sessions included.
class SshBoard {
 public:
  /// @throws std::runtime_error when the server does not answer.
  explicit SshBoard(const std::string& mark);
  ~SshBoard();

  /// "ssh://127.0.0.1:PORT".
  const std::string& address() const { return address_; }
  /// What has `tether` reach it.
  std::vector<std::pair<std::string, std::string>> environment() const;
  /// A program in the PATH of the board's sessions.
  void install(const std::string& name, const std::filesystem::path& program) const;
  /// The same, by its whole content.
  void install_text(const std::string& name, const std::string& text) const;
  /// Kills the server's side of every connection, as a power cut would.
  void cut_connections() const;
  /// Sessions' temporary files.
  std::filesystem::path temporary_folder() const { return folder_ / "tmp"; }
  std::filesystem::path folder() const { return folder_.path(); }

 private:
  void write_settings(const std::string& mark);
  std::string ssh() const;

  TempFolder folder_;
  std::uint16_t port_ = 0;
  std::string address_;
  std::unique_ptr<Process> server_;
};

}  // namespace tether::system_test
