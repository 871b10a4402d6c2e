#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/campaign/campaign_plan.h>
#include <tether/runner/trial.h>
#include <tether/scenario/target.h>

namespace tether::runner {

/// The user starts the SUT, on any machine: `--target wait`.
struct WaitForSut {
  friend bool operator==(const WaitForSut&, const WaitForSut&) = default;
};

/// Where SUTs run instead of on their condition's computers: nowhere else, on the target of a file,
/// on a board, or where the user starts them.
using TargetChoice =
    std::variant<std::monostate, std::filesystem::path, scenario::SshAddress, WaitForSut>;

/// As users write it: "" is none, "wait" is WaitForSut, a text with "://" is an address, and any
/// other text is a name or file. Reads no file.
/// @throws Error(kUsage) as `scenario::parse_ssh_address`.
TargetChoice parse_target_choice(const std::string& text);
/// The inverse, for files whose path has a '/'.
std::string to_text(const TargetChoice& choice);

/// One trial as a value: the files that it names and all that is laid over them. Commands make
/// requests of their options; servers and workers get them as text. Reading the files makes a
/// TrialSpec of it.
struct TrialRequest {
  std::filesystem::path scenario;             ///< a file
  std::vector<scenario::Setting> settings{};  ///< replace its values
  std::filesystem::path profile{};            ///< a file, above all sensors' settings; empty: none
  sim::WorldOptions reading{};                ///< of its world
  std::string condition{};                    ///< of the scenario; empty: its first one
  TargetChoice target{};
  std::string simulator{};                 ///< empty: the condition's
  std::string unknown_stages{};            ///< empty: the condition's
  std::optional<double> slowdown{};        ///< of its computers
  std::optional<double> cpu_time_scale{};  ///< this machine is so many times faster than another
  std::optional<double> real_time_factor{};
  std::uint64_t seed = 1;
  bool record_images = false;      ///< besides what the scenario says
  std::string listen{};            ///< "host:port"; empty: see TrialSpec
  bool uses_tunnel = false;        ///< see TrialSpec
  std::filesystem::path folder{};  ///< empty: out/SCENARIO/CONDITION/seed-N, whose run is replaced
  bool replaces_earlier = false;   ///< a run in the folder

  friend bool operator==(const TrialRequest&, const TrialRequest&) = default;
};

/// As JSON in one line.
std::string to_json(const TrialRequest& request);
/// The inverse. @throws Error(kBadFile) for other texts.
TrialRequest parse_trial_request(std::string_view json);

/// That of a campaign's trial.
TrialRequest request_of(const campaign::TrialPlan& plan);

/// Reads the files, and lays the rest over them.
/// @throws Error(kBadFile) and Error(kUsage) if a file or a value cannot be used.
TrialSpec make_trial(const TrialRequest& request);

}  // namespace tether::runner
