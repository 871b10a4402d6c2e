#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/error.h>
#include <tether/computer/clock.h>
#include <tether/energy/meter.h>
#include <tether/os/counted_program.h>

/// Where the SUT runs: this host, a virtual target on it, or a board (profiles/targets/*.toml).
namespace tether::scenario {

/// A machine that OpenSSH can reach.
struct SshAddress {
  std::string destination;  ///< "user@board", or a name from the user's ssh_config
  int port = 0;             ///< 0: as in ssh_config

  friend bool operator==(const SshAddress&, const SshAddress&) = default;
};

struct Target {
  std::filesystem::path file;     ///< absolute; empty: made on the command line
  std::string name;               ///< letters, digits, '_', '-', '.', '@'
  std::string description;        ///< one line; may be empty
  std::optional<SshAddress> ssh;  ///< none: this host
  computer::Clock clock{};
  /// The bounds of the factor's interval, as its calibration found it; none: not known.
  std::optional<std::pair<double, double>> cpu_factor_interval{};
  int cores = 0;                      ///< that the SUT may use; 0: all
  std::vector<std::string> launcher;  ///< before the SUT's command, e.g. {"qemu-aarch64", …}
  /// Where SUT programs named without '/' are: on the board, or on this host (absolute). Empty:
  /// in the PATH there; on this host, beside `tether` first.
  std::string program_folder;
  std::optional<energy::Computer> power{};  ///< none: not known
  std::optional<os::Emulator>
      emulator{};  ///< with computer::ClockKind::kCounted only; `launcher` then starts it

  /// The line of the key in the file, if that has it once.
  FileLocation where(std::string_view key) const;
};

/// "ssh://[user@]host[:port]". @throws Error(kUsage) about the text.
SshAddress parse_ssh_address(std::string_view text);
/// The inverse of parse_ssh_address.
std::string to_string(const SshAddress& address);

/// Reads and checks a target file (docs/guide/target.md). Paths in it that are on this host are
/// relative to its own folder; words of `launcher` are such paths if they begin with "./" or "../".
/// @throws Error(kBadFile) as `load_scenario`.
Target load_target(const std::filesystem::path& file);

}  // namespace tether::scenario
