#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>
#include <tether/scenario/scenario.h>
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

/// A SUT to start on a board.
struct BoardSut {
  std::string uav;
  std::vector<std::string> words;  ///< its command line on the board
  std::size_t program = 0;         ///< index of the program in `words`
  std::size_t supervisor = 0;      ///< how many words of tether-exec `words` starts with
  os::Environment environment;
  std::filesystem::path log;  ///< on this machine; for stdout and stderr of the SUT
};

/// Why a SUT's process has ended.
enum class SutEndCause {
  kItself,      ///< its program exited or was ended by a signal
  kNotStarted,  ///< it could not be started
  kConnection,  ///< the connection to the board was lost
  kBoard,       ///< the board is no longer held
};
struct SutEnd {
  SutEndCause cause = SutEndCause::kItself;
  std::string description;  ///< "was ended by signal 11 (Segmentation fault)"
};

/// A board reached over SSH and reserved for one run: no other run of Tether can use it meanwhile.
/// All processes that were started there end with the object, and within seconds if this process or
/// the connection ends. No files of the run remain on the board. Not thread-safe.
class Board {
 public:
  /// Connects to the board and reserves it. A stop request ends waiting and commands. @throws
  /// Error(kSetup) about the address if it cannot be reached, or is reserved by another run.
  explicit Board(const scenario::SshAddress& address, std::stop_token stop = {});
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  SshConnection& connection() { return connection_; }
  /// The address at which the board sees this machine.
  const std::string& host_address() const { return host_address_; }

  /// Of the run, on the board; private to it, and removed with it.
  const std::string& folder() const { return folder_; }

  /// Copies a file to the board; returns its path there. @throws Error(kSetup) about the file.
  std::string copy(const std::filesystem::path& file);
  /// Starts a SUT. The returned process is ssh on this machine, which ends with the SUT; `end_of`
  /// returns how the SUT ended.
  std::unique_ptr<os::ChildProcess> start(const BoardSut& sut);
  /// How a SUT ended. `last_line`: of its log.
  SutEnd end_of(const os::ChildExit& exit, const std::string& last_line);

  /// Why the board is out of reach; none if it is not.
  std::optional<std::string> lost();
  /// Ends the SUTs. @return whether the board confirmed it in time.
  bool end_suts();
  /// Copies the files in the SUT's TETHER_OUT to `folder`; returns a warning if that failed.
  std::optional<std::string> bring_back(const std::string& uav,
                                        const std::filesystem::path& folder);

 private:
  void hold();
  std::string keeper_output() const;
  std::string describe_release() const;
  bool wait_for_keeper(const std::string& word, Duration limit);
  std::string prologue() const;
  void send_heartbeat(const std::stop_token& stop) const;

  SshConnection connection_;
  std::string host_address_;
  std::string folder_;  // of the run, on the board
  os::FileDescriptor to_keeper_;
  std::unique_ptr<os::ChildProcess> keeper_;
  std::jthread heartbeat_;
  int copies_ = 0;
};

}  // namespace tether::board
