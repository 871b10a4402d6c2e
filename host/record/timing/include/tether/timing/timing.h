#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/text.h>
#include <tether/link/messages.h>
#include <tether/record/reader.h>

namespace tether::timing {

/// What a run did not see or could not measure well, so that its verdict may be wrong. The part of
/// it that follows from the files is Warning::can_change_verdict.
struct Doubt {
  enum class Kind {
    kUnseenWait,       ///< the program waited on something that Tether does not see; amount: s,
                       ///< on the modelled computer at most, as if something else computed
    kParallelThreads,  ///< threads computed in parallel, but their times were added; amount: CPU
                       ///< time over wall time, > 1
    kDiskWait,         ///< the program waited for the disk, which its clock does not count; s
    kStretchedWait,    ///< the program waited, and a factor made more of it; s, as it was
    kSlightWait,       ///< as the first, too short to matter unless a limit is as close; amount:
                       ///< share of its time
    kBusyMachine,  ///< the machine was busy or uneven; amount: the share by which its times can be
                   ///< off
  };
  Kind kind = Kind::kUnseenWait;
  std::string subject;  ///< the UAV of the program, or the board; empty: this machine
  double amount = 0.0;
  /// The timing file whose times are replayed, if it is a doubt of the runs in which they were
  /// measured; empty: of this run.
  std::string recorded_in{};

  /// Without this one, the times would be other ones: nothing is known of the computer. Otherwise
  /// the amount says by how much they can be off.
  bool is_of_unseen_time() const { return kind < Kind::kSlightWait; }

  friend bool operator==(const Doubt&, const Doubt&) = default;
};
inline constexpr std::size_t kDoubts = 6;  ///< kinds
/// "unseen_wait", "parallel_threads", "disk_wait", "stretched_wait", "slight_wait",
/// "busy_machine".
std::string_view name(Doubt::Kind kind);

// What programs computed between their calls, by stage: taken from records, and kept in timing
// files (docs/guide/timing.md).

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

/// With fewer samples, quantiles of a stage say little.
inline constexpr std::size_t kFewSamples = 20;

/// The times of one stage. Times in seconds.
struct StageRow {
  std::string stage;
  std::size_t count = 0;
  double median_s = 0.0, p95_s = 0.0, p99_s = 0.0, worst_s = 0.0;
  double share = 0.0;  ///< of all computing
  friend bool operator==(const StageRow&, const StageRow&) = default;
};

/// The stages with the largest share first.
std::vector<StageRow> stage_rows(const Timing& timing);

/// One line for each stage with few samples.
std::vector<std::string> warnings(const std::vector<StageRow>& rows);

/// A time in milliseconds, for tables: "12.345".
std::string in_ms(double seconds);
/// For a person, in milliseconds; a list if the table is wider than `columns`.
std::string to_text(const std::vector<StageRow>& rows, std::size_t columns = kAnyColumns);

/// How much longer a stage takes than before, by its median. Shares: 0.12 is +12 %.
struct StageChange {
  std::string stage;
  double change = 0.0;
  double low = 0.0, high = 0.0;  ///< bounds of the 95 % interval, by bootstrap
  std::size_t few = 0;           ///< the smaller number of samples, if it is below kFewSamples
};

struct Comparison {
  std::vector<StageChange> stages;   ///< that both have; the largest share of the old one first
  std::vector<std::string> added;    ///< only in the new one
  std::vector<std::string> removed;  ///< only in the old one
  std::string doubt{};               ///< by how much the times can be off; empty: not known
};

/// Pure: draws of the bootstrap are keyed by the stage. Stages whose share of the old computing
/// time is below 0.1 % are left out.
Comparison compare(const Timing& now, const Timing& before);

/// Whether a stage is slower than the limit allows: 0.2 for +20 %.
bool is_beyond(const Comparison& comparison, double limit);

/// A line for each stage. With a limit: how many times slower it may still become.
std::string to_text(const Comparison& comparison, const double* limit);

}  // namespace tether::timing
