#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <tether/board/ssh_connection.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/pipe.h>
#include <tether/scenario/scenario.h>

namespace tether::board {

/// A SUT to start on a board.
struct BoardSut {
  std::string uav;
  std::vector<std::string> words;  ///< as the board takes them
  std::size_t program = 0;         ///< which of the words is the program
  bool concurrent = false;         ///< the first of the words is tether-exec
  os::Environment environment;
  std::filesystem::path log;  ///< on this machine; gets the SUT's stdout and stderr
};

/// What ended a SUT's process.
enum class SutEndCause {
  kItself,      ///< its program ended, by itself or by a signal
  kNotStarted,  ///< there was nothing to start
  kConnection,  ///< the connection to the board was lost
  kBoard,       ///< the board is no longer held
};
struct SutEnd {
  SutEndCause cause = SutEndCause::kItself;
  std::string description;  ///< "was ended by signal 11 (Segmentation fault)"
};

/// A board that SSH reaches, held for one run: no other run of Tether uses it meanwhile. Whatever
/// was started there ends with the object, and within seconds when this process or the connection
/// is gone, however that came. Nothing of the run stays on the board. Not thread-safe.
class Board {
 public:
  /// Connects and holds it, until a stop is requested. @throws Error(kSetup) when it cannot be
  /// reached, or another run, which is named, holds it.
  explicit Board(const scenario::SshAddress& address, std::stop_token stop = {});
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  SshConnection& connection() { return connection_; }
  /// This machine's address as the board sees it.
  const std::string& host_address() const { return host_address_; }

  /// Copies a file of this machine there; returns its path there. @throws Error(kSetup).
  std::string copy(const std::filesystem::path& file);
  /// Starts a SUT. The process is this machine's end of it, and ends when it does; `end_of` says
  /// how it ended.
  std::unique_ptr<os::ChildProcess> start(const BoardSut& sut);
  /// What came of a SUT whose process has ended.
  SutEnd end_of(const os::ChildExit& exit, const std::string& last_words);

  /// Why the board is out of reach; none while it is not.
  std::optional<std::string> lost();
  /// Ends the SUTs. @return whether the board said so in time.
  bool end_suts();
  /// Copies what the SUT left in its TETHER_OUT into `folder`; a warning if that was not possible.
  std::optional<std::string> bring_back(const std::string& uav,
                                        const std::filesystem::path& folder);

 private:
  void hold();
  std::string keeper_said() const;
  std::string let_go() const;  // once the keeper has ended
  bool wait_for_keeper(const std::string& word, Duration limit);
  std::string prologue() const;
  void beat(const std::stop_token& stop) const;

  SshConnection connection_;
  std::string host_address_;
  std::string folder_;  // of the run, on the board
  os::FileDescriptor to_keeper_;
  std::unique_ptr<os::ChildProcess> keeper_;
  std::jthread heart_;
  int copies_ = 0;
};

}  // namespace tether::board
