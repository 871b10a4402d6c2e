#pragma once

#include "child_process.h"
#include "sut_environment.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/scenario/scenario.h>

namespace tether::app {

/// The scenario's SUTs as processes of this machine; they end with the object. Not thread-safe.
class SutProcesses {
 public:
  /// None yet.
  SutProcesses() = default;
  /// Starts them all, each with its output in `folder`/sut-UAV.log. TETHER_OUT tells each where to
  /// leave files: `folder`, or `folder`/UAV where there are several. @throws Error(kSetup).
  void start(const scenario::Scenario& scenario, const SutRun& run,
             const std::filesystem::path& folder);

  /// Before every SUT has joined: how the first one ended that did; none while all run.
  std::optional<std::string> early_end();
  /// After a SUT was lost: how those that ended did so, "; " before each; empty: nothing is known.
  std::string post_mortem();
  /// Gives those that have finished the time to leave by themselves.
  void let_leave();

 private:
  struct Sut {
    std::string uav;
    std::filesystem::path log;
    std::unique_ptr<ChildProcess> process;
  };
  static std::string describe_end(Sut& sut);

  std::vector<Sut> suts_;
};

}  // namespace tether::app
