#include "commands.h"
#include "print_report.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/experiment/campaign_results.h>
#include <tether/report/report.h>

namespace tether::app {

namespace {

struct ReportOptions {
  std::filesystem::path folder;
  std::string format = "text";
};

using Render = std::string (*)(const report::Table&);

int run(const ReportOptions& options) {
  const experiment::CampaignResults results = experiment::read_campaign_results(options.folder);
  if (options.format == "csv") {
    fmt::print("{}", to_csv(report::trials_table(results)));
    return 0;
  }
  const Render render = options.format == "markdown" ? report::to_markdown : report::to_text;
  for (const report::Table& table : report::report_tables(results))
    fmt::print("{}\n", render(table));
  return 0;
}

}  // namespace

void print_campaign_summary(const std::filesystem::path& folder) {
  const experiment::CampaignResults results = experiment::read_campaign_results(folder);
  for (const auto& scenario : results.scenarios)
    fmt::print("{}\n", to_text(report::paper_form_table(scenario)));
  fmt::print(
      "Records and results: {0}\n"
      "Look next at:  tether report {0}      all tables: intervals, comparisons, the optimism of "
      "\"no sync\"\n"
      "               tether audit {0}/SCENARIO/CONDITION/seed-NNNN/record.mcap\n"
      "               any record.mcap opens in Foxglove (log time = simulated time)\n",
      folder.string());
}

void add_report_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = program.add_subcommand("report", "Tables of a campaign's results");
  command->add_option("folder", options->folder, "Folder of a campaign")->required();
  command
      ->add_option("--format", options->format,
                   "text, markdown, or csv (one row per trial and metric)")
      ->check(CLI::IsMember({"text", "markdown", "csv"}))
      ->capture_default_str();
  command->footer(R"(Examples:
  tether report out/face_anchor
  tether report out/face_anchor --format csv)");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace tether::app
