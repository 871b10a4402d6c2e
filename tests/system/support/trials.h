#pragma once

#include "files.h"
#include "process.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tether/record/reader.h>

namespace tether::system_test {

/// Writes data/face_anchor.toml (with a UAV whose camera has 320 × 240 pixels) or data/hover.toml
/// (with the SUT of bad_sut.cpp in that mode) into `folder` with the substitutions made, and
/// returns the file.
std::filesystem::path write_face_scenario(const std::filesystem::path& folder,
                                          const std::vector<Substitution>& substitutions = {});
std::filesystem::path write_hover_scenario(const std::filesystem::path& folder,
                                           const std::string& mode,
                                           const std::vector<Substitution>& substitutions = {});

/// The hover scenario's world.
std::filesystem::path hover_world();

/// data/scenarios/NAME.toml as it is shipped, with the substitutions made:
/// FOLDER/scenarios/NAME.toml.
std::filesystem::path write_shipped_scenario(const std::filesystem::path& folder,
                                             const std::string& name,
                                             const std::vector<Substitution>& substitutions = {});
/// Charges the shipped scenarios' condition "host" so much for each phase of computing, whatever it
/// took.
Substitution scripted_host(int computing_ms);

/// Of the hover scenario's condition "host": another clock.
inline const Substitution kScripted{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"};
inline const Substitution kWall{"clock = \"cpu\"", "clock = \"wall\""};
/// Of the hover scenario: a run that no limit ends.
inline const std::vector<Substitution> kEndless{{"time_limit_s = 5", "time_limit_s = 600"},
                                                {"hang_limit_s = 2", "hang_limit_s = 60"}};

/// A campaign of so many trials of hover.toml beside it under each condition. `more` goes to that
/// scenario's table.
std::filesystem::path write_campaign(const std::filesystem::path& folder, int trials,
                                     const std::string& more = "");

/// `tether` with these arguments. A mark makes its processes findable.
Command tether(const std::vector<std::string>& arguments, const std::string& mark = "none");

/// The files that a run left. @throws std::runtime_error when one is missing or cannot be read.
nlohmann::json read_result(const std::filesystem::path& folder);
record::Record read_record(const std::filesystem::path& folder);
/// The record of a run that goes on; none where there is none yet.
std::optional<record::Record> record_so_far(const std::filesystem::path& folder);
/// The exit code of `tether audit`.
int audit_code(const std::filesystem::path& folder);

/// What does not depend on how fast anything ran: result.json without "this_run", and without the
/// limit of the simulator's speed, which is a setting of the run.
std::string timeless_result(const std::filesystem::path& folder);
/// The record as text with everything in it but wall times.
std::string timeless_record(const std::filesystem::path& folder);

/// Two runs left the same result and the same record, whatever they took.
void expect_same_runs(const std::filesystem::path& a, const std::filesystem::path& b);

/// Writes the record as a file that reads back the same.
void write_record(const std::filesystem::path& file, const record::Record& record);

/// One run whose SUTs are started by the test, so that they can have a wire of their own.
class ExternalRun {
 public:
  /// Starts `tether run --target wait --quiet` and waits until it listens.
  /// @throws std::runtime_error with its output if it does not.
  ExternalRun(const std::filesystem::path& scenario, const std::filesystem::path& out,
              const std::vector<std::string>& options = {});

  /// host:port.
  const std::string& address() const { return address_; }
  static std::string token();
  /// Starts a SUT: `arguments` with the environment that joins it to this run. What is given in
  /// `environment` goes over that.
  std::unique_ptr<Process> start_sut(const std::vector<std::string>& arguments,
                                     const Variables& environment = {}) const;
  Output wait(std::chrono::duration<double> limit = std::chrono::seconds(90)) {
    return tether_->wait(limit);
  }
  Process& process() { return *tether_; }

 private:
  std::unique_ptr<Process> tether_;
  std::string address_;
  std::string clock_;  // of the condition, as in TETHER_CLOCK
};

/// A slow wire to a run.
class SlowWire {
 public:
  /// @throws std::runtime_error if it does not start.
  SlowWire(const std::string& address, int delay_ms, int mbit_s);
  /// Where SUTs connect instead.
  const std::string& address() const { return address_; }

 private:
  Process proxy_;
  std::string address_;
};

/// tether-sut with the parameters of data/face_anchor.toml.
std::vector<std::string> face_sut();

}  // namespace tether::system_test
