#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/link/messages.h>
#include <tether/record/reader.h>
#include <tether/timing/doubt.h>

/// What programs computed between their calls, by stage: taken from records, and kept in timing
/// files (docs/guide/timing.md).
namespace tether::timing {

/// A call of a SUT, and what was computed before it, each stage once.
struct Call {
  std::string call;  ///< a sensor's name, "command", "sleep" or "finish"
  std::vector<link::StageTime> stages;
  friend bool operator==(const Call&, const Call&) = default;
};

/// All calls of one SUT in one run.
struct Run {
  std::string uav;
  std::uint64_t seed = 0;
  std::vector<Call> calls;
  friend bool operator==(const Run&, const Run&) = default;
};

using Build = std::vector<link::BuildPart>;

/// Runs of one program in one scenario on one machine.
struct Timing {
  std::string scenario;
  std::string condition{};  ///< empty: several, or a file of schema 1
  std::string program;      ///< name and version
  std::string build_id;     ///< empty: it has none
  /// By UAV, of its program. Empty in files of schema 1, which cannot be replayed exactly.
  std::map<std::string, Build> builds{};
  std::string board;        ///< the target's name
  std::string clock;        ///< as in TETHER_CLOCK
  std::string recorded_at;  ///< when the newest run was recorded: UTC as in ISO 8601
  /// Of the same program under a counted clock: mean ET of each stage [ns].
  std::map<std::string, double> counted_ns{};
  std::vector<Doubt> doubts{};  ///< of the runs: of each kind and subject, the largest
  std::vector<Run> runs;
  friend bool operator==(const Timing&, const Timing&) = default;
};

/// The timing of a record. Interactions without stages (records of Tether 0.1.0, other clients) are
/// named by the calls around them.
/// @throws Error(kBadFile) about the file if the run was not synchronised, or its SUTs differ in
/// program or clock.
Timing of_record(const record::Record& record, const std::filesystem::path& file,
                 const std::string& recorded_at);

/// The calls of one SUT of a record, however its time was measured.
Run run_of(const record::Record& record, const record::SutInfo& sut);

/// With this, the names of a build's parts begin that are libraries: "library libc.so.6".
inline constexpr std::string_view kLibraryPart = "library ";

/// What differs between two builds, for people: "argument 4 was "30", is "60"". None if nothing
/// does.
std::optional<std::string> difference(const Build& was, const Build& is);

/// How many flights these are, for people: "2 runs", "1 run of 2 UAVs".
std::string runs_text(const Timing& timing);

/// Adds what one of the runs has in doubt.
void add(Timing& timing, const Doubt& doubt);
/// Adds the runs of `more`, which was read from `file`.
/// @throws Error(kBadFile) about `file` if scenario, program, machine or clock differ, or a run of
/// the same UAV and seed is there.
void add(Timing& timing, const Timing& more, const std::filesystem::path& file);

/// @throws Error(kBadFile) about `file`, from which the timing was read, if it is of another
/// scenario.
void require_scenario(const Timing& timing, const std::string& scenario,
                      const std::filesystem::path& file);
/// @throws Error(kBadFile) about `file` if its runs were not under a counted clock.
void require_counted(const Timing& timing, const std::filesystem::path& file);

/// Whether the file begins as a timing file does.
bool is_timing_file(const std::filesystem::path& file);
/// @throws Error(kBadFile) with file and line if it is missing, empty, truncated, damaged, or of
/// another schema.
Timing read_timing(const std::filesystem::path& file);
/// Completely or not at all. @throws Error(kSetup) with the file.
void write_timing(const std::filesystem::path& file, const Timing& timing);

/// Whether the program did not name the stage: what it computed outside of its own stages, between
/// two calls (link::stage_between).
bool is_between_calls(const Timing& timing, const std::string& stage);

/// The times of each stage in all runs of the UAV [ns], in their order; of every UAV if the name is
/// empty.
std::map<std::string, std::vector<double>> samples_of(const Timing& timing,
                                                      const std::string& uav = "");

}  // namespace tether::timing
