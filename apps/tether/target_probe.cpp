#include "target_probe.h"

#include "board_scripts.h"

#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/experiment/target_readings.h>

namespace tether::app {

namespace {

constexpr Duration kLimit = std::chrono::seconds(10);

std::string script_of(ProbeDepth depth) {
  return fmt::format("depth={}\n{}", depth == ProbeDepth::kBrief ? "brief" : "full", kTargetProbe);
}

/// Goes with its object.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tether-probe-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(ErrorCode::kSetup, name + ": no folder for the probe can be made");
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

record::Readings probe_here(ProbeDepth depth) {
  const PrivateFolder folder;
  return experiment::parse_readings(
      run_captured({"sh"}, script_of(depth), kLimit, folder.path(), true).out);
}

record::Readings probe_board(const SshConnection& connection, ProbeDepth depth) {
  return experiment::parse_readings(connection.run(script_of(depth), kLimit, {}, true).out);
}

}  // namespace tether::app
