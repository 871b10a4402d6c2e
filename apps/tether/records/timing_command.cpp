#include "commands/commands.h"
#include "options/junit_option.h"
#include "options/output_file.h"
#include "reading/file_kind.h"
#include "terminal/print.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_results.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/record/reader.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>
#include <tether/runner/trial_folder.h>
#include <tether/stats/sample_statistics.h>
#include <tether/timing/timing.h>

/// `tether timing`: the stages of records and timing files, as tables, as a file, or compared.
namespace tether::app {

namespace {

struct TimingOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path against;
  std::optional<double> limit_percent;
  std::vector<std::filesystem::path> counted;
  std::filesystem::path out;
  std::filesystem::path csv;
  std::filesystem::path html;
  std::filesystem::path junit;
  bool json = false;
};

namespace fs = std::filesystem;

/// When the run of a record was flown, as its result says; else when the record was written.
std::string recorded_at(const fs::path& record) try {
  return campaign::read_result(record.parent_path()).this_run.started_at;
} catch (const Error&) {
  const auto written = std::chrono::file_clock::to_sys(fs::last_write_time(record));
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(
          std::chrono::time_point_cast<std::chrono::system_clock::duration>(written))));
}

/// Of the flight beside a record; none: it has no result.
std::optional<campaign::TrialResult> result_beside(const fs::path& record) try {
  return campaign::read_result(record.parent_path());
} catch (const Error&) {
  return std::nullopt;
}

timing::Timing read_any(const fs::path& given) {
  const bool is_run = kind_of(given) == FileKind::kRun;
  const fs::path file = is_run ? given / runner::kRecordFile : given;
  if (timing::is_timing_file(file)) return timing::read_timing(file);
  require_kind(file, FileKind::kRecord);
  const record::Record record = record::read_record(file);
  if (const std::string damage = record::describe_damage(record); !damage.empty())
    complain("warning: " + file.string() + ": " + damage);
  timing::Timing timing = timing::of_record(record, file, recorded_at(file));
  if (const auto result = result_beside(file)) {
    if (result->outcome == campaign::Outcome::kFailed)
      throw Error(ErrorCode::kBadFile, {file.string()},
                  fmt::format("is of a flight that failed ({}), which does not say how long the "
                              "program takes. Give flights that were flown to their end",
                              result->reason))
          .about(file.string());
    for (const timing::Doubt& doubt : result->this_run.doubts) timing::add(timing, doubt);
  }
  return timing;
}

timing::Timing read_all(const std::vector<fs::path>& files) {
  timing::Timing timing = read_any(files.front());
  for (std::size_t i = 1; i < files.size(); ++i) timing::add(timing, read_any(files[i]), files[i]);
  return timing;
}

/// The work of each stage under a counted clock.
void add_counted(timing::Timing& timing, const std::vector<fs::path>& files) {
  const timing::Timing counted = read_all(files);
  timing::require_counted(counted, files.front());
  timing::require_scenario(counted, timing.scenario, files.front());
  if (counted.build_id != timing.build_id)
    throw Error(ErrorCode::kBadFile, {files.front().string()},
                fmt::format("is of build \"{}\", but the timing is of \"{}\". Count the program "
                            "that was measured.",
                            counted.build_id, timing.build_id))
        .about("--counted");
  // Libraries can be those of another machine's system.
  const auto own_parts = [](timing::Build build) {
    std::erase_if(build, [](const auto& part) { return part.name.starts_with("library "); });
    return build;
  };
  for (const auto& [uav, build] : counted.builds)
    if (const auto measured = timing.builds.find(uav); measured != timing.builds.end())
      if (const auto other = timing::difference(own_parts(measured->second), own_parts(build)))
        throw Error(
            ErrorCode::kBadFile, {files.front().string()},
            fmt::format("is of another program of UAV \"{}\": {}. Count the program that was "
                        "measured.",
                        uav, *other))
            .about("--counted");
  for (const auto& [stage, times_ns] : timing::samples_of(counted))
    timing.counted_ns[stage] = stats::mean(times_ns);
}

void require_fit(const TimingOptions& options) {
  const auto refuse = [](const char* option, const char* why) {
    throw Error(ErrorCode::kUsage, fmt::format("{}: {}", option, why)).about(option);
  };
  if (options.limit_percent && options.against.empty()) refuse("--limit", "needs --against OLD.");
  if (!options.junit.empty() && !options.limit_percent)
    refuse("--junit",
           "needs --against OLD and --limit PERCENT: without a limit, no case can fail.");
  if (!options.counted.empty() && options.out.empty())
    refuse("--counted", "needs --out FILE, into which the counted work is written.");
  require_output_file("--out", options.out, OutputFormat::kTiming);
  require_output_file("--csv", options.csv, OutputFormat::kCsv);
  require_output_file("--html", options.html, OutputFormat::kHtml);
  if (options.against.empty()) return;
  for (const auto& [option, file] :
       {std::pair("--out", options.out), std::pair("--csv", options.csv),
        std::pair("--html", options.html)})
    if (!file.empty()) refuse(option, "cannot be used with --against.");
}

/// The results of the flights of these records. A timing file has what they had in doubt.
campaign::ConditionResults flights_of(const std::vector<fs::path>& files,
                                      const std::string& condition) {
  campaign::ConditionResults flights{condition, {}, 0};
  for (const fs::path& file : files) try {
      const bool is_run = kind_of(file) == FileKind::kRun;
      if (is_run || !timing::is_timing_file(file)) {
        flights.trials.push_back(campaign::read_result(is_run ? file : file.parent_path()));
      } else if (const timing::Timing timing = timing::read_timing(file); !timing.doubts.empty()) {
        campaign::TrialResult& measured = flights.trials.emplace_back();
        measured.outcome = campaign::Outcome::kGoalReached;
        measured.this_run.doubts = timing.doubts;
        for (timing::Doubt& doubt : measured.this_run.doubts)
          doubt.recorded_in = file.filename().string();
      }
    } catch (const Error&) {  // a record alone
    }
  flights.planned = flights.trials.size();
  return flights;
}

/// What the flights themselves doubt about their times, as a line. @throws Error(kSetup) if there
/// is a limit, and they have no answer, which no limit can pass.
std::string doubt_about(std::vector<fs::path> files, const std::string& condition,
                        const TimingOptions& options) {
  if (!options.against.empty()) files.push_back(options.against);
  const campaign::ConditionResults flights = flights_of(files, condition);
  if (flights.trials.empty()) return "";
  const report::ConditionVerdict verdict = report::verdict_of(flights);
  if (verdict.ruling <= report::Ruling::kUnseen) {
    const report::Answer answer = report::answer_of(verdict);
    if (options.limit_percent)
      throw Error(ErrorCode::kSetup, {files.front().string()},
                  "cannot be held against a limit. " + answer.lead + answer.rest)
          .about(condition);
    return answer.lead + answer.rest;
  }
  const auto* const busy = verdict.doubt(campaign::Doubt::Kind::kBusyMachine);
  if (busy == nullptr) return "";
  return fmt::format("The machine was busy or uneven: its times may be off by about {:.0f} %.",
                     100.0 * busy->largest.amount);
}

int print_change(const timing::Timing& now, const TimingOptions& options) {
  const timing::Timing before = read_any(options.against);
  timing::require_scenario(before, now.scenario, options.against);
  if (now.board != before.board || now.clock != before.clock) {
    const std::string differs =
        fmt::format("measured on \"{}\" with the clock \"{}\", before on \"{}\" with \"{}\"",
                    now.board, now.clock, before.board, before.clock);
    if (options.limit_percent)
      throw Error(ErrorCode::kBadFile, {options.against},
                  "cannot be held against a limit: " + differs +
                      ". Compare runs of one kind, or leave --limit out")
          .about(now.board);
    complain("warning: " + differs);
  }
  timing::Comparison comparison = timing::compare(now, before);
  comparison.doubt = doubt_about(options.runs, now.condition, options);
  std::optional<double> limit;
  if (options.limit_percent) limit = *options.limit_percent / 100.0;
  if (!options.junit.empty())
    os::write_file_atomically(options.junit, report::change_junit(now, before, comparison, *limit));
  if (options.json)
    fmt::print("{}", report::change_json(now, before, comparison, limit));
  else
    print(timing::to_text(comparison, limit ? &*limit : nullptr));
  return limit && timing::is_beyond(comparison, *limit) ? 1 : 0;
}

int time_all(const TimingOptions& options) {
  timing::Timing timing = read_all(options.runs);
  if (!options.against.empty()) return print_change(timing, options);
  if (!options.counted.empty()) add_counted(timing, options.counted);
  const auto rows = timing::stage_rows(timing);
  if (!options.csv.empty()) os::write_file_atomically(options.csv, report::timing_csv(rows));
  if (!options.html.empty()) os::write_file_atomically(options.html, report::timing_page(timing));
  if (!options.out.empty()) timing::write_timing(options.out, timing);
  if (options.json) {
    fmt::print("{}", report::timing_json(timing));
    return 0;
  }
  print(report::answer_text({report::timing_answer(rows)}, report::timing_advice(timing, rows),
                            markup_of_stdout()));
  print(fmt::format("{}: {}, build {}, clock {}, on {}, recorded {}, {}\n\n{}", timing.scenario,
                    timing.program, timing.build_id.empty() ? "unknown" : timing.build_id,
                    timing.clock, timing.board, timing.recorded_at, timing::runs_text(timing),
                    timing::to_text(rows, os::text_columns(STDOUT_FILENO))));
  if (const std::string doubt = doubt_about(options.runs, timing.condition, options);
      !doubt.empty())
    complain("warning: " + doubt);
  for (const std::string& warning : timing::warnings(rows)) complain("warning: " + warning);
  return 0;
}

int time_stages(const TimingOptions& options, const std::stop_token&) {
  require_fit(options);
  return with_junit(options.junit, "timing", [&] { return time_all(options); });
}

Options timing_rows(TimingOptions& o) {
  return {
      {"runs", "Runs of one program in one scenario: records, folders of runs, timing files",
       &o.runs, required()},
      {"--out FILE", "Timing file to write, for conditions with clock = \"replayed\"", &o.out},
      {"--counted RUN",
       "Runs of the same program under a counted target: --out then also has the work of each "
       "stage, for mode = \"scaled\"",
       &o.counted},
      {"--csv FILE", "Table to write as CSV, in seconds", &o.csv},
      {"--html FILE", "Page to write, with a histogram of each stage", &o.html},
      {"--against RUN",
       "Earlier run or timing file: print the change of each stage instead, with its 95 % interval",
       &o.against},
      {"--limit PERCENT", "With --against: the most by which a stage may become slower",
       &o.limit_percent, range(0, 1e6)},
      {"--json", "Print the table, or the change, as JSON", &o.json},
      {"--junit FILE",
       "With --limit: also write the change as JUnit's XML for continuous integration, with a test "
       "case for each stage",
       &o.junit}};
}

}  // namespace

Command timing_command() {
  return make_command(
      "timing", "Report what each stage of a program computes, or how that changed", timing_rows,
      R"(Exit codes: 0 no stage is slower than --limit allows, or there is no limit, 1 one is, 2 wrong
use or a bad file, 3 a flight that is held against --limit has no answer.

Examples:
  tether timing out/one/record.mcap
  tether timing out/campaign/face_anchor/target/seed-* --out board.timing
  tether timing out/new --against board.timing --limit 10
  tether timing out/new --against board.timing --limit 10 --junit timing.xml)",
      time_stages);
}

}  // namespace tether::app
