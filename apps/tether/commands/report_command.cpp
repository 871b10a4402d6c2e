#include "commands/commands.h"
#include "commands/size_options.h"
#include "options/output_file.h"
#include "reading/file_kind.h"
#include "terminal/print.h"
#include "terminal/print_report.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/ranges.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign/result.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>
#include <tether/runner/trial_folder.h>

namespace tether::app {

namespace {

struct ReportOptions {
  std::filesystem::path folder;
  std::string format = "text";
  std::filesystem::path out;
};

constexpr const char *kHtml = "html", *kJson = "json";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorCode::kBadFile, {path.string()}, why).about(path.string());
}

/// " Give one of those in it: out/one, out/two."; empty: there are none.
std::string inside(const std::filesystem::path& folder) {
  constexpr std::size_t kMost = 4;
  std::vector<std::string> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (results_in(entry.path())) found.push_back(entry.path().string());
  if (found.empty()) return "";
  std::ranges::sort(found);
  const bool has_more = found.size() > kMost;
  found.resize(std::min(found.size(), kMost));
  return fmt::format(" Give one of those in it: {}{}", fmt::join(found, ", "),
                     has_more ? ", …" : "");
}

/// Refuses everything but a run or campaign with results. A run that was killed leaves only its
/// record.
void require_result(const std::filesystem::path& folder) {
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(folder, failed);
  if (failed) refuse(folder, failed.message() + ". Give the folder of a run or a campaign.");
  if (!is_folder) {
    require_kind(folder, FileKind::kRun);
    refuse(folder, "is not a folder. Give the folder of a run or a campaign.");
  }
  if (access(folder.c_str(), R_OK | X_OK) != 0)
    refuse(folder, fmt::format("cannot be read: {}", std::strerror(errno)));
  if (results_in(folder)) return;
  const std::filesystem::path record = folder / runner::kRecordFile;
  if (!std::filesystem::exists(record))
    refuse(folder, fmt::format("is neither a run nor a campaign: it has no {} and no {}.{}",
                               campaign::kResultFile, campaign::kCampaignFile, inside(folder)));
  refuse(folder, fmt::format("this run has no result, because it is still running or was killed. "
                             "To check its record, type: tether audit {}",
                             record.string()));
}

std::string joined(const std::vector<report::Table>& tables, bool is_markdown) {
  std::string text;
  for (const report::Table& table : tables)
    text +=
        (is_markdown ? to_markdown(table) : to_text(table, os::text_columns(STDOUT_FILENO))) + "\n";
  return text;
}

std::vector<report::Table> run_tables(const campaign::CampaignResults& results) {
  const auto& trial = results.scenarios.front().conditions.front().trials.front();
  std::vector<report::Table> tables = {report::run_table(trial)};
  if (!trial.clauses.empty()) tables.push_back(report::clauses_table(trial));
  if (!trial.energy.empty()) tables.push_back(report::energy_table(trial));
  tables.push_back(report::basis_table(results));
  return tables;
}

/// Its trials are those that the statistics asked for, not all of a campaign.
void refuse_size(const std::filesystem::path& folder) {
  if (!campaign::read_manifest(folder).name.starts_with(campaign::kSizePrefix)) return;
  const std::filesystem::path page = folder / campaign::kReportFile;
  if (!std::filesystem::exists(page))
    refuse(folder,
           "was written by tether size, which has no answer yet. Call it again with "
           "--resume.");
  refuse(folder, fmt::format("was written by tether size. Its answer is in {}, for scripts in "
                             "size.json beside it; to make it again, call tether size with "
                             "--resume.",
                             page.string()));
}

std::string rendered(const ReportOptions& options) {
  require_result(options.folder);
  const bool run = results_in(options.folder) == FileKind::kRun;
  if (!run) refuse_size(options.folder);
  if (options.format == kHtml && run) return report::run_page(options.folder);
  const campaign::CampaignResults results = run ? report::read_run_results(options.folder)
                                                : campaign::read_campaign_results(options.folder);
  if (options.format == kHtml) return report::campaign_page(results, options.folder);
  if (options.format == "csv") return to_csv(report::trials_table(results));
  if (options.format == "summary-csv") return to_csv(report::summaries_table(results));
  const bool is_markdown = options.format == "markdown";
  const std::vector<report::Verdict> verdicts = report::verdicts_of(results);
  if (options.format == kJson) return report::verdicts_json(verdicts);
  std::vector<report::Table> tables = run ? run_tables(results) : report::report_tables(results);
  std::vector<report::Table> first;
  for (const auto& points : report::by_scenario(verdicts)) {
    first.push_back(report::rulings_table(points));
    if (report::Table stages = report::stages_table(points); !stages.rows.empty())
      first.push_back(std::move(stages));
  }
  tables.insert(tables.begin(), first.begin(), first.end());
  const report::Markup markup = is_markdown           ? report::Markup::kMarkdown
                                : options.out.empty() ? markup_of_stdout()
                                                      : report::Markup::kPlain;
  const std::string text = report::verdict_text(verdicts, markup) + joined(tables, is_markdown);
  return is_markdown ? text : wrapped(text, os::text_columns(STDOUT_FILENO));
}

OutputFormat output_format(const std::string& format) {
  if (format == kHtml) return OutputFormat::kHtml;
  return format.ends_with("csv") ? OutputFormat::kCsv : OutputFormat::kText;
}

/// Prints or writes the results of a campaign or a run.
int print_report(const ReportOptions& options, const std::stop_token&) {
  require_output_file("--out", options.out, output_format(options.format));
  const std::string text = rendered(options);
  std::filesystem::path out = options.out;
  if (out.empty() && options.format == kHtml) out = options.folder / campaign::kReportFile;
  if (out.empty()) {
    fmt::print("{}", text);
  } else {
    os::write_file_atomically(out, text);
    fmt::print("{}\n", out.string());
  }
  return 0;
}

Options report_rows(ReportOptions& o) {
  return {{"folder", "Folder of a campaign or a run", &o.folder, required()},
          {"--format",
           "text, markdown, csv (one row per trial and metric), summary-csv (one row per condition "
           "and metric), json (the answers), or html (one self-contained page; needs gnuplot)",
           &o.format, one_of({"text", "markdown", "csv", "summary-csv", kJson, kHtml})},
          {"--out FILE", "File to write [standard output; for html, report.html in the folder]",
           &o.out}};
}

}  // namespace

Command report_command() {
  return make_command("report", "Report the results of a campaign or a run", report_rows,
                      R"(Examples:
  tether report out/campaign
  tether report out/campaign --format html
  tether report out/one --format html --out one.html
  tether report out/campaign --format csv --out trials.csv)",
                      print_report);
}

void print_campaign_summary(const campaign::CampaignResults& results,
                            const std::filesystem::path& folder) {
  const std::vector<report::Verdict> verdicts = report::verdicts_of(results);
  print(report::verdict_text(verdicts, markup_of_stdout()));
  const auto show = [](const report::Table& table) {
    print(to_text(table, os::text_columns(STDOUT_FILENO)) + "\n");
  };
  for (const auto& points : report::by_scenario(verdicts)) show(report::rulings_table(points));
  const auto sweeps = report::sweeps_of(results);
  for (const report::Sweep& sweep : sweeps) show(report::sweep_table(sweep));
  for (const auto& scenario : results.scenarios)
    if (scenario.swept_from.empty()) show(report::paper_form_table(scenario));
  print(
      fmt::format("Records and results: {0}\nNext steps:\n  tether report {0} --format html   one "
                  "page with tables and plots\n  tether report {0}                 only the "
                  "tables\n  tether audit {0}/SCENARIO/CONDITION/seed-NNNN/record.mcap\n  open a "
                  "record.mcap in Foxglove (log time is simulated time)\n",
                  folder.string()));
}

}  // namespace tether::app
