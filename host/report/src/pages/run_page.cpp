#include "answers/comparisons.h"
#include "pages/html.h"
#include "pages/page_figures.h"
#include "pages/verdict_html.h"
#include "plots/board_lanes.h"
#include "plots/mission_timeline.h"
#include "plots/radio_lanes.h"
#include "plots/svg.h"
#include "tables/radio_table.h"
#include "tables/report_format.h"

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>

namespace tether::report {
namespace {

const campaign::TrialResult& trial_of(const campaign::CampaignResults& results) {
  return results.scenarios.front().conditions.front().trials.front();
}

std::string outcome_text(campaign::Outcome outcome) {
  switch (outcome) {
    case campaign::Outcome::kGoalReached:
      return "Goal reached";
    case campaign::Outcome::kGoalMissed:
      return "Goal missed";
    case campaign::Outcome::kFailed:
      return "Failed";
  }
  return std::string(name(outcome));
}

std::string outcome_sentences(const campaign::TrialResult& trial) {
  std::string text = fmt::format("{}: {}.", outcome_text(trial.outcome), trial.reason);
  for (const campaign::SutResult& sut : trial.suts) {
    if (!sut.outcome.empty())
      text += fmt::format(" The SUT of {} reports: {}.", sut.uav, sut.outcome);
  }
  return text;
}

std::string plots_part(FigureMaker& figures, const record::Record& record) {
  std::vector<PlottedRun> runs;
  std::string times, motion;
  for (const record::SutInfo& sut : record.header.suts) {
    const PlottedRun run{&record, sut.uav, sut.uav, runs.size()};
    runs.push_back(run);
    motion += figures.plot(motion_plot(run), fmt::format("Height and speed of {}.", sut.uav));
    times += figures.plot(
        timeline_plot(run, Extent::kFirstInteractions),
        fmt::format("Simulated and execution time of {} over wall time: first interactions.",
                    sut.uav));
    times += figures.plot(
        timeline_plot(run, Extent::kWhole),
        fmt::format("Simulated and execution time of {} over wall time: whole run.", sut.uav));
    times += figures.plot(lag_plot(run),
                          fmt::format("Lag ε = ET − ST when each request of {} arrived.", sut.uav));
  }
  const std::string path =
      figures.plot(path_plot(runs), fmt::format("Path, seen from above. {}", kPathCaption));
  return element("h2", "The flight") + path + motion +
         folded("How the simulation kept up with the program", times);
}

constexpr std::size_t kMostContacts = 100;

std::string contacts_part(const record::Record& record) {
  const std::string title = element("h2", "Contacts");
  if (!record.header.reports_contacts)
    return title + element("p", "Not reported by the simulator, or by the version of Tether.");
  if (record.contacts.empty()) return title + element("p", "None.");
  Table table;
  table.headings = {single_headings({"UAV", "With", "ST (s)", "Speed (m/s)"})};
  table.text_columns = 2;
  for (const auto& [at, order, contact] : record.contacts) {
    if (table.rows.size() == kMostContacts) {
      table.notes.push_back(
          fmt::format("The first {} of {} contacts.", kMostContacts, record.contacts.size()));
      break;
    }
    table.rows.push_back(
        {contact.uav, contact.with, decimals(to_seconds(contact.at)), decimals(contact.speed_m_s)});
  }
  return title + to_html(table, "Contacts");
}

std::string metrics_part(const campaign::TrialResult& trial) {
  Table metrics = run_table(trial);
  metrics.title.clear();
  std::erase(metrics.notes, trial.reason + ".");  // outcome_sentences has it
  return element("h2", "Metrics and limits") + to_html(metrics, "Metrics and limits");
}

std::string mission_part(const campaign::TrialResult& trial) {
  Table table = clauses_table(trial);
  if (table.rows.empty()) return "";
  table.title.clear();
  std::string html = element("h2", "Mission");
  for (const campaign::SutResult& sut : trial.suts) {
    const std::string drawing = mission_timeline(trial, sut.uav);
    if (!drawing.empty())
      html +=
          figure(drawing,
                 fmt::format(
                     "Tasks (bars) and clauses (lines) of {}. A line is the time that a "
                     "clause is about, a stroke its deadline, a dot the time when it "
                     "was decided. The thin curve is the margin over time, with 0 in the middle of "
                     "the lane. At the right: status and margin.",
                     sut.uav),
                 "plot");
  }
  return html + to_html(table, "Mission");
}

std::vector<std::string> uavs_on(const record::Record& record, const record::BoardInfo& board) {
  std::vector<std::string> uavs;
  for (const record::SutInfo& sut : record.header.suts)
    if (sut.board == board.name) uavs.push_back(sut.uav);
  return uavs;
}

std::string boards_part(const record::Record& record) {
  std::string html;
  for (const record::BoardInfo& board : record.header.boards)
    if (board.is_real) {
      html += element("p", fmt::format("The programs of {} ran and were stopped together on the "
                                       "real board \"{}\". Its operating system shared the cores: "
                                       "which one computed when is not known.",
                                       joined_with_and(uavs_on(record, board)), board.name));
    } else if (const std::string drawing = board_lanes(record, board); !drawing.empty()) {
      html +=
          figure(drawing,
                 fmt::format("Cores of \"{}\": which SUT computed when, and with which share. "
                             "If more SUTs compute than there are cores, each has a part of one.",
                             board.name),
                 "plot");
    }
  return html.empty() ? "" : element("h2", "Shared boards") + html;
}

std::string radio_part(const record::Record& record) {
  const std::string drawing = radio_lanes(record);
  if (drawing.empty()) return "";
  return element("h2", "Radio") +
         figure(drawing,
                "Messages of each link by the time at which they were sent: upwards those that "
                "arrived, downwards those that were lost. At the right, the share that arrived, "
                "and the median of their delays.",
                "plot") +
         to_html(radio_table(record), "Radio");
}

std::string record_part(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "record.mcap";
  try {
    const record::Record record = record::read_record(file, {.images = true});
    FigureMaker figures(1);
    std::string html = contacts_part(record) + boards_part(record);
    html += radio_part(record) + plots_part(figures, record);
    const std::string frames = figures.frames(record);
    if (!frames.empty()) html += element("h2", "Camera images") + frames;
    if (const std::string damage = record::describe_damage(record); !damage.empty())
      html += element("p", "Only the part of the record before the damage is shown: " + damage);
    return html;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadFile) throw;
    return element("p", fmt::format("No plots: {}", error.what()));
  }
}

}  // namespace

campaign::CampaignResults read_run_results(const std::filesystem::path& folder) {
  return results_of_run(campaign::read_result(folder));
}

campaign::CampaignResults results_of_run(const campaign::TrialResult& trial) {
  campaign::ScenarioResults scenario;
  scenario.scenario = trial.scenario;
  for (const campaign::MetricValue& metric : trial.metrics) scenario.metrics.push_back(metric.name);
  scenario.conditions = {{trial.condition, {trial}, 1}};
  campaign::CampaignResults results;
  results.manifest.name =
      fmt::format("{}, {}, seed {}", trial.scenario, trial.condition, trial.seed);
  results.manifest.seeds = {trial.seed};
  results.manifest.settings = trial.versions;
  results.scenarios = {scenario};
  return results;
}

std::string run_page(const std::filesystem::path& folder) {
  const campaign::CampaignResults results = read_run_results(folder);
  const campaign::TrialResult& trial = trial_of(results);
  const std::string& title = results.manifest.name;
  std::string body = element("h1", title);
  const std::vector<Verdict> verdicts = verdicts_of(results);
  body += answer_html(verdicts) + verdict_picture_html({verdicts});
  body += element("p", outcome_sentences(trial)) + "\n" + problems_box(problems(results));
  if (trial.outcome != campaign::Outcome::kFailed)
    body += metrics_part(trial) + mission_part(trial);
  if (const Table stages = stages_table(verdicts); !stages.rows.empty())
    body += element("h2", "Where the time goes") + to_html(stages);
  if (const Table energy = energy_table(trial); !energy.rows.empty()) body += to_html(energy);
  body += record_part(folder);
  body += element("h2", "Setup and checks") + basis_html(results);
  return html_page(title, body);
}

}  // namespace tether::report
