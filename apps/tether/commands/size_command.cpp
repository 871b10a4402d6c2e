#include "commands/commands.h"
#include "commands/size_axis.h"
#include "commands/size_trials.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "terminal/print.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/plots.h>

/// `tether size`: flies until the question is answered, and writes the answer.
namespace tether::app {

namespace {

void require_share(const std::string& option, double share) {
  if (share > 0.0 && share < 1.0) return;
  refuse_option(option,
                fmt::format("{} is not between 0 and 1. {}", share,
                            share == 1.0 ? "No number of flights shows that for certain; use a "
                                           "share such as 0.95."
                                         : "Use a share such as 0.9."));
}

void write_answer(const report::SizeAnswer& answer, const std::filesystem::path& out) {
  os::write_file_atomically(out / kSizeFile, answer.json);
  print(report::answer_text(answer.answers, answer.advice, markup_of_stdout()));
  os::write_file_atomically(out / kSizeDrawing, report::draw_svg(answer.plot));
  os::write_file_atomically(out / campaign::kReportFile, report::size_page(answer));
  fmt::print("Page: {}\nDrawing: {}\nNumbers: {}\n", (out / campaign::kReportFile).string(),
             (out / kSizeDrawing).string(), (out / kSizeFile).string());
}

int code_of(const report::SizeAnswer& answer) {
  if (std::ranges::any_of(answer.trials, &campaign::TrialResult::has_unseen_time))
    return exit_code(ErrorCode::kSetup);
  const bool is_good =
      answer.boards.empty()
          ? answer.is_answered
          : std::ranges::all_of(answer.boards, &report::SizeAnswer::OfBoard::suffices);
  return is_good ? 0 : 1;
}

int find(const SizeOptions& options, const std::stop_token& stop) {
  require_share("--success", options.success);
  require_share("--confidence", options.confidence);
  const std::unique_ptr<SizeAxis> axis =
      options.axis == "uavs" ? uavs_axis(options) : slowdown_axis(options);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/size") / axis->folder : options.out;
  SizeTrials trials(options, *axis, out, stop);
  const sizing::SearchEnd end = trials.fly();
  const bool is_answered = end == sizing::SearchEnd::kAnswered;
  const bool is_interrupted = end == sizing::SearchEnd::kInterrupted;
  const int why = is_answered ? 0 : trials.say_why(end);
  if (!is_answered && !(is_interrupted && trials.flown() >= sizing::kLeastFlights)) return why;
  const report::SizeAnswer answer =
      axis->answer({trials.settings(), trials.not_flown(), is_interrupted});
  write_answer(answer, out);
  if (!options.junit.empty())
    os::write_file_atomically(options.junit, report::to_junit(answer, out));
  return is_answered ? code_of(answer) : why;
}

int size(const SizeOptions& options, const std::stop_token& stop) {
  return with_junit(options.junit, options.scenario.string(), [&] { return find(options, stop); });
}

Options size_rows(SizeOptions& o) {
  return concatenated(
      {{scenario_argument(o.scenario),
        {"--axis",
         "What to vary: how slow the computer may be, or how many UAVs it carries. With uavs, "
         "--target, --interval and --unsynchronised are rejected",
         &o.axis, one_of({"slowdown", "uavs"})},
        condition_option(o.condition),
        {"--target TARGET",
         "Virtual target to evaluate, several times if you like: name of a shipped target, or a "
         "file (TOML)",
         &o.targets},
        {"--success SHARE", "Share of flights that must reach the goal, above 0 and below 1",
         &o.success},
        {"--confidence SHARE", "Confidence of the answer's interval, above 0 and below 1",
         &o.confidence},
        {"--interval FACTOR",
         "Stop when its upper bound is at most so many times the lower one [1.3]", &o.interval},
        {"--between LEAST,MOST",
         "Slowdowns [1,40], or numbers of UAVs [1, all], to fly: LEAST,MOST",
         &o.between,
         {.has_commas = true, .count = 2}},
        {"--max-trials", "Maximum number of flights", &o.max_trials, range(1, 10000)},
        {"--unsynchronised NAME",
         "Condition without synchronisation to compare: fly it with the same slowdowns and seeds, "
         "which doubles the flights",
         &o.unsynchronised},
        {"--out FOLDER",
         "Folder for the flights, report.html, size.svg and size.json [out/size/SCENARIO; for "
         "UAVs, SCENARIO-uavs]",
         &o.out},
        resume_option(o.resume),
        {"--force", "Remove the earlier flights in the folder", &o.force}},
       engine_options(o.engine),
       {junit_option(o.junit), simulator_option(o.simulator)},
       reading_options(o.reading)});
}

}  // namespace

Command size_command() {
  return make_command(
      "size", "Find the slowest sufficient computer, or how many UAVs it carries", size_rows,
      R"(Exit codes: 0 every --target is sufficient, or none is given, some computer of --between is, and
the answer is as narrow as --interval asks (of UAVs: decided), 1 otherwise, 2 wrong use or a bad
file, 3 interrupted, or flights failed.

Examples:
  tether size face_anchor --condition target
  tether size face_anchor --target six_times_slower --jobs 2
  tether size face_anchor --success 0.95 --interval 1.2 --max-trials 600
  tether size face_anchor --condition target --unsynchronised "target, no sync"
  tether size four_on_one_board --axis uavs)",
      size);
}

}  // namespace tether::app
