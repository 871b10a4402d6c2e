#pragma once

#include "sut_environment.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/board/board.h>
#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

namespace tether::runner {

/// The scenario's SUTs, here or on a board; they end with the object. Not thread-safe.
class SutProcesses {
 public:
  /// None yet.
  SutProcesses() = default;
  /// Starts them all, each with its output in `folder`/sut-UAV.log. TETHER_OUT tells each where to
  /// leave files: `folder`, or `folder`/UAV where there are several. @throws Error(kSetup).
  void start(const scenario::Scenario& scenario, const SutRun& run,
             const std::filesystem::path& folder);
  /// The same on the board, which must outlive them. The scenario's files that their parameters
  /// name are copied there.
  void start_on(board::Board& board, const scenario::Scenario& scenario, const SutRun& run,
                const std::filesystem::path& folder);

  /// Before every SUT has joined: how the first one ended that did; none while all run.
  std::optional<std::string> early_end();
  /// Of those here: whose process a signal or a debugger has stopped; none where none is.
  std::optional<std::string> stopped() const;
  /// Why the board with the SUTs is out of reach; none where there is none, or it is not.
  std::optional<std::string> lost();
  /// Whether the last words of one that has ended are that it cannot connect to that address.
  bool has_failed_to_connect(const std::string& address);
  /// After a SUT was lost: how those that ended did so, "; " before each; empty: nothing is known.
  std::string post_mortem();
  /// Gives those that have finished the time to leave by themselves. A note for each that a signal
  /// ended, or that did not leave.
  std::vector<std::string> let_leave();
  /// Ends those on a board, and brings their files into the run's folder; a warning for each whose
  /// files stay there.
  std::vector<std::string> bring_back();

 private:
  struct Sut {
    std::string uav;
    std::filesystem::path log;
    std::filesystem::path files;  // of TETHER_OUT, here
    std::string program;
    std::unique_ptr<os::ChildProcess> process;
  };
  std::string describe_end(Sut& sut) const;

  board::Board* board_ = nullptr;
  std::vector<Sut> suts_;
};

}  // namespace tether::runner
