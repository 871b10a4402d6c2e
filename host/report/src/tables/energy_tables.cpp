#include "tables/report_format.h"

#include <array>
#include <set>

#include <fmt/format.h>

#include <tether/report/report.h>

// What flights take from the battery: of a run, and over the trials of a campaign.
namespace tether::report {
namespace {

std::vector<std::string> with_causes(std::vector<std::string> headings) {
  for (std::size_t i = 0; i < energy::kCauses; ++i)
    headings.emplace_back(name(static_cast<energy::Cause>(i)));
  return headings;
}

std::vector<std::string> energy_row(const std::string& uav,
                                    const campaign::ConditionResults& condition) {
  std::vector<double> totals_J, used, more;
  std::array<std::vector<double>, energy::kCauses> causes_J;
  for (const campaign::TrialResult& trial : condition.trials)
    for (const campaign::UavEnergy& own : trial.energy) {
      if (trial.outcome == campaign::Outcome::kFailed || own.uav != uav) continue;
      totals_J.push_back(campaign::total_J(own.spent_J));
      used.push_back(100.0 * (own.charge_from - own.charge_to));
      if (own.more_flights()) more.push_back(*own.more_flights());
      for (std::size_t i = 0; i < energy::kCauses; ++i) causes_J[i].push_back(own.spent_J[i]);
    }
  const auto mean = [](const std::vector<double>& values, const char* format) {
    return values.empty() ? kNone
                          : fmt::format(fmt::runtime(format), campaign::summarise(values).mean);
  };
  std::vector<std::string> row = {
      uav,
      condition.condition,
      std::to_string(totals_J.size()),
      mean(totals_J, "{:.0f}"),
      totals_J.empty() ? kNone : interval(campaign::summarise(totals_J).ci95),
      mean(used, "{:.2f}"),
      mean(more, "{:.1f}")};
  for (const auto& cause_J : causes_J) row.push_back(mean(cause_J, "{:.1f}"));
  return row;
}

}  // namespace

Table energy_table(const campaign::TrialResult& trial) {
  Table table;
  table.title = "Energy (J)";
  table.text_columns = 2;
  table.headings = {single_headings(with_causes({"UAV", "Task", "Total"}))};
  const auto add = [&](const std::string& uav, const std::string& task,
                       const energy::Energies_J& spent_J) {
    std::vector<std::string> row = {uav, task, fmt::format("{:.1f}", campaign::total_J(spent_J))};
    for (const double cause_J : spent_J) row.push_back(fmt::format("{:.1f}", cause_J));
    table.rows.push_back(std::move(row));
  };
  for (const campaign::UavEnergy& own : trial.energy) {
    for (const auto& [task, spent_J] : own.tasks) add(own.uav, task, spent_J);
    add(own.uav, "whole flight", own.spent_J);
    const auto more = own.more_flights();
    table.notes.push_back(
        fmt::format("{}: {:.1f} % of the charge left of {:.1f} %{}; least voltage {:.2f} V.",
                    own.uav, 100.0 * own.charge_to, 100.0 * own.charge_from,
                    more ? fmt::format(", enough for {:.1f} more such flights", *more) : "",
                    own.least_voltage_V));
  }
  return table;
}

Table energy_table(const campaign::ScenarioResults& scenario) {
  Table table;
  table.title = fmt::format("Energy of a flight of {} (J)", scenario.scenario);
  table.text_columns = 2;
  table.headings = {
      single_headings(with_causes({"UAV", "Condition", "Flights", "Total", "95 % interval",
                                   "Charge used (%)", "More flights"}))};
  std::set<std::string> uavs;
  for (const auto& condition : scenario.conditions)
    for (const campaign::TrialResult& trial : condition.trials)
      for (const campaign::UavEnergy& own : trial.energy) uavs.insert(own.uav);
  for (const std::string& uav : uavs)
    for (const auto& condition : scenario.conditions)
      table.rows.push_back(energy_row(uav, condition));
  if (!uavs.empty())
    table.notes = {"Means over the trials that did not fail. Interval: Student's t."};
  return table;
}

}  // namespace tether::report
