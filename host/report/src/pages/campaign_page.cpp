#include "answers/comparisons.h"
#include "pages/html.h"
#include "pages/page_figures.h"
#include "pages/verdict_html.h"
#include "plots/svg.h"
#include "tables/paper_figures.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <tether/report/report.h>
#include <tether/report/verdict.h>

// The page of a campaign: the answers with a picture and problems on top, then a section for each
// scenario, whose parts are built by one function each in reading order, and the setup last. A part
// without data is empty.
namespace tether::report {
namespace {

std::string heading_of(const campaign::ScenarioResults& scenario) {
  const PaperTable* paper = find_paper_table(scenario.paper_table);
  if (paper == nullptr) return scenario.scenario;
  return fmt::format("{} (the paper's Table {})", scenario.scenario, paper->number);
}

std::string contents(const campaign::CampaignResults& results) {
  if (results.scenarios.size() < 2) return "";
  std::string html = "<nav aria-label=\"Contents\"><ul>";
  for (std::size_t i = 0; i < results.scenarios.size(); ++i) {
    html += fmt::format("<li><a href=\"#scenario-{}\">{}</a></li>", i + 1,
                        escape_markup(heading_of(results.scenarios[i])));
  }
  return html + "<li><a href=\"#basis\">Setup and checks</a></li></ul></nav>\n";
}

std::string optimism_part(const campaign::ScenarioResults& scenario) {
  const std::vector<Comparison> comparisons = optimism(scenario);
  if (comparisons.empty()) return "";
  std::string html =
      element("h3", "Optimism of the unsynchronised test") + "<div class=\"optimism\">\n";
  for (const Comparison& comparison : comparisons)
    html += element("p", optimism_sentence(comparison, *scenario.find_metric(comparison.metric)));
  return html + "</div>\n" + to_html(optimism_table(scenario));
}

std::string clauses_part(FigureMaker& figures, const campaign::ScenarioResults& scenario) {
  const Table table = clauses_table(scenario);
  if (table.rows.empty()) return "";
  std::string plots, times;
  for (const judge::ClauseVerdict& clause : clauses_of(scenario)) {
    plots += figures.plot(margin_plot(scenario, clause), "");
    times += figures.plot(times_plot(scenario, clause), "");
  }
  if (!plots.empty())
    plots = element("p",
                    "Each point is one trial, as in “All trials”. Left of the line at 0, the "
                    "clause was missed by that much.") +
            plots;
  if (!times.empty())
    times = element("h3", "Reaction times and loops") +
            element("p",
                    "Each trial has 21 points, the quantiles of its times from 0 to 100 %. The box "
                    "spans the quartiles, the thick line is the median, and the thin one is the "
                    "limit.") +
            times + to_html(times_table(scenario));
  return to_html(table) + folded("Margins of the clauses in all trials", plots) + times;
}

std::string distributions_part(FigureMaker& figures, const campaign::ScenarioResults& scenario) {
  std::string html;
  for (const std::string& metric : scenario.metrics)
    html += figures.plot(distribution_plot(scenario, metric), "");
  if (html.empty()) return "";
  return element("h3", "All trials") +
         "<p class=\"soft\">Each point is one trial. The box spans the quartiles, and the thick "
         "line is "
         "the median.</p>\n" +
         html;
}

std::vector<PlottedRun> runs_of(const SeedRecords& records) {
  std::vector<PlottedRun> runs;
  for (const SeedRecords::OfCondition& one : records.records) {
    for (const record::SutInfo& sut : one.record.header.suts) {
      const bool alone = one.record.header.suts.size() == 1;
      runs.push_back({&one.record, sut.uav, alone ? one.condition : one.condition + ", " + sut.uav,
                      one.series});
    }
  }
  return runs;
}

std::string path_part(FigureMaker& figures, const SeedRecords& records,
                      const std::vector<PlottedRun>& runs) {
  if (runs.empty()) return "";
  const std::string plot = figures.plot(
      path_plot(runs),
      fmt::format("Seed {}. {}", records.records.front().record.header.seed, kPathCaption));
  return plot.empty() ? "" : element("h3", "Path, seen from above") + plot;
}

std::string timelines_part(FigureMaker& figures, const std::vector<PlottedRun>& runs) {
  std::string html;
  for (const PlottedRun& run : runs) {
    html += figures.plot(
        timeline_plot(run, Extent::kFirstInteractions),
        fmt::format("“{}”, seed {}: first interactions.", run.label, run.record->header.seed));
  }
  return html.empty() ? "" : element("h3", "Simulated and execution time over wall time") + html;
}

// The images of one condition are enough: the last synchronised one, which is usually the slowest.
const SeedRecords::OfCondition* with_images(const SeedRecords& records) {
  const SeedRecords::OfCondition* found = nullptr;
  for (const SeedRecords::OfCondition& one : records.records) {
    if (one.record.images.empty() && one.record.raw_images.empty()) continue;
    if (found == nullptr || one.record.header.policy == record::kConservativeBarrier) found = &one;
  }
  return found;
}

std::string frames_part(FigureMaker& figures, const SeedRecords& records) {
  const SeedRecords::OfCondition* one = with_images(records);
  const std::string frames = one != nullptr ? figures.frames(one->record) : "";
  if (frames.empty()) return "";
  return element("h3", "Camera images") +
         element("p", fmt::format("“{}”, seed {}.", one->condition, one->record.header.seed)) +
         frames;
}

std::string tables_part(const campaign::ScenarioResults& scenario) {
  std::string html = folded("All statistics", to_html(details_table(scenario)));
  if (!compare_conditions(scenario).empty())
    html += folded("Differences between the conditions",
                   list(difference_sentences(scenario)) + to_html(comparisons_table(scenario)));
  return html;
}

/// What was compared, and where the time goes.
std::string verdict_tables(const std::vector<Verdict>& points) {
  std::string html = to_html(rulings_table(points));
  const Table stages = stages_table(points);
  if (stages.rows.empty()) return html;
  return html + folded("Where the computing time goes: all stages", to_html(stages));
}

std::string scenario_section(FigureMaker& figures, const campaign::ScenarioResults& scenario,
                             const Verdict& verdict, const std::filesystem::path& folder,
                             std::size_t number, bool has_answer) {
  const SeedRecords records = read_seed_records(scenario, folder);
  const std::vector<PlottedRun> runs = runs_of(records);
  std::string html = fmt::format("<section id=\"scenario-{}\">\n", number);
  html += element("h2", heading_of(scenario));
  if (!scenario.description.empty()) html += element("p", scenario.description);
  if (has_answer) html += answer_html({verdict}, "h3");
  if (scenario.swept_from.empty()) html += verdict_tables({verdict});
  html += to_html(paper_form_table(scenario));
  html += clauses_part(figures, scenario);
  if (const Table energy = energy_table(scenario); !energy.rows.empty()) html += to_html(energy);
  html += optimism_part(scenario);
  html += distributions_part(figures, scenario);
  html += path_part(figures, records, runs);
  html += timelines_part(figures, runs);
  html += frames_part(figures, records);
  html += tables_part(scenario);
  html += problems_box(records.unreadable);
  return html + "</section>\n";
}

std::string sweep_section(FigureMaker& figures, const Sweep& sweep,
                          const std::vector<Verdict>& verdicts) {
  std::vector<Verdict> points;
  std::ranges::copy_if(verdicts, std::back_inserter(points), [&](const Verdict& verdict) {
    return !verdict.point.empty() && verdict.scenario == sweep.scenario;
  });
  std::string html = "<section>\n" + element("h2", sweep.scenario + ": sweep") +
                     verdict_tables(points) +
                     figures.plot(sweep_plot(sweep), "The bars are exact 95 % intervals.");
  for (const std::string& metric : sweep.points.front()->metrics)
    html += figures.plot(sweep_plot(sweep, metric),
                         "Means. Each circle is a trial; a dotted line is the limit.");
  if (const Table tests = sweep_tests_table(sweep); !tests.rows.empty()) html += to_html(tests);
  return html + folded("Table", to_html(sweep_table(sweep))) + "</section>\n";
}

}  // namespace

std::string campaign_page(const campaign::CampaignResults& results,
                          const std::filesystem::path& folder) {
  FigureMaker figures(results.scenarios.size());
  const std::string& name = results.manifest.name;
  std::string body = element("h1", name);
  const std::vector<Verdict> verdicts = verdicts_of(results);
  const std::vector<std::vector<Verdict>> groups = by_scenario(verdicts);
  body += groups.size() == 1 ? answer_html(groups.front()) : answers_html(groups);
  body += verdict_picture_html(groups);
  if (!results.manifest.description.empty()) body += element("p", results.manifest.description);
  body += problems_box(problems(results)) + contents(results);
  for (const Sweep& sweep : sweeps_of(results)) body += sweep_section(figures, sweep, verdicts);
  for (std::size_t i = 0; i < results.scenarios.size(); ++i)
    body += scenario_section(figures, results.scenarios[i], verdicts[i], folder, i + 1,
                             groups.size() > 1 && verdicts[i].point.empty());
  body += "<section id=\"basis\">\n" + element("h2", "Setup and checks") + basis_html(results) +
          "</section>\n";
  return html_page(name, body);
}

}  // namespace tether::report
