#pragma once

#include "suts/sut_environment.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/board/board.h>
#include <tether/coordinator/coordinator.h>
#include <tether/os/child_process.h>
#include <tether/scenario/scenario.h>

namespace tether::runner {

/// The processes of a scenario's SUTs, here or on boards. They end with the object, and so do all
/// processes that local SUTs have started, also in sessions of their own. Not thread-safe.
class SutProcesses {
 public:
  SutProcesses() = default;
  ~SutProcesses();
  SutProcesses(const SutProcesses&) = delete;
  SutProcesses& operator=(const SutProcesses&) = delete;

  /// Starts all of them but those that the user starts, here or on their board, which must outlive
  /// them; `boards` has one for each UAV, or null. Empty: all run here. Those of a group of the run
  /// have one more process, which starts and stops their programs, with its output in
  /// `folder`/exec-BOARD.log. The output of each SUT goes to `folder`/sut-UAV.log, and its
  /// TETHER_OUT is `folder`, or `folder`/UAV if there are several. The scenario's files that
  /// parameters name are copied to the board. @throws Error(kSetup).
  void start(const scenario::Scenario& scenario, const SutRun& run,
             const std::filesystem::path& folder, const std::vector<board::Board*>& boards = {});

  /// How the first SUT that has ended did so; none while all run.
  std::optional<std::string> early_end();
  /// Which local SUT's process was stopped by a signal or a debugger; none if none was.
  std::optional<std::string> stopped() const;
  /// Why a board is out of reach; none if none is.
  std::optional<std::string> lost();
  /// Whether a SUT has ended with that address in the last line of its output.
  bool has_failed_to_connect(const std::string& address);
  /// After the loss of a SUT: how processes ended, each after "; ", the lost one first, since
  /// others end because of it. Empty if nothing is known. Output is left out that ends with the
  /// last part of the reason, after ": ".
  std::string post_mortem(const std::string& reason, const std::string& lost_uav = "");
  /// Waits until finished SUTs have exited. Returns a text for each that was ended by a signal,
  /// that did not exit, or whose exit code is a failure although it reported its goal as reached.
  std::vector<std::string> await_exit(const std::vector<coordinator::SutReport>& reports);
  /// Ends SUTs on a board, and copies their files to the run's folder. Returns a warning for each
  /// whose files could not be copied.
  std::vector<std::string> bring_back();

 private:
  struct Sut {
    std::string uav;   // empty: it is the process of a group
    std::string name;  // for messages
    std::filesystem::path log;
    std::filesystem::path files;  // its TETHER_OUT on this machine
    std::string program;
    std::unique_ptr<os::ChildProcess> process;
    board::Board* board = nullptr;  // null: this machine
    bool is_as_is = false;
    bool has_all_processes = false;
  };
  void start_group(const scenario::Scenario& scenario, const SutRun& run, const SutGroup& group,
                   const std::filesystem::path& folder, board::Board* board);
  static bool has_ended_well(Sut& sut);
  std::string describe_end(Sut& sut, const std::string& reason = "") const;

  bool has_local_ = false;
  std::vector<Sut> suts_;
};

}  // namespace tether::runner
