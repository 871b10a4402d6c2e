#include "energy.h"

#include "metric_outcome.h"

#include <algorithm>

#include <fmt/format.h>

namespace tether::campaign {
namespace {

energy::Energies_J spent_of(const record::Battery& battery) {
  return {battery.lift_J,      battery.moving_J,  battery.idle_J,
          battery.computing_J, battery.sensors_J, battery.resistance_J};
}

/// Those of a UAV, up to the moment when its SUT finished, or the run ended.
std::vector<const record::Battery*> batteries_of(const std::string& uav,
                                                 const record::Record& record) {
  const std::optional<SimTime> finish = finish_time(record, uav);
  std::vector<const record::Battery*> own;
  for (const auto& logged : record.batteries) {
    const record::Battery& battery = logged.message;
    if (battery.uav == uav && (!finish || battery.at <= *finish)) own.push_back(&battery);
  }
  return own;
}

/// The last one that is not after `at`, or else the first.
const record::Battery& in_effect(const std::vector<const record::Battery*>& own, SimTime at) {
  const auto after = std::ranges::upper_bound(own, at, {}, &record::Battery::at);
  return **(after == own.begin() ? after : std::prev(after));
}

energy::Energies_J between(const record::Battery& from, const record::Battery& to) {
  energy::Energies_J spent = spent_of(to);
  const energy::Energies_J before = spent_of(from);
  for (std::size_t i = 0; i < spent.size(); ++i) spent[i] -= before[i];
  return spent;
}

/// Whether a UAV whose battery gives nothing has lost its power.
bool draws_always(const record::SutInfo& sut) {
  return sut.energy && sut.energy->idle_W + sut.energy->sensors_W + sut.energy->lift_W > 0.0;
}

}  // namespace

std::vector<UavEnergy> energy_of(const record::Record& record,
                                 const std::vector<judge::TaskSpan>& tasks) {
  std::vector<UavEnergy> all;
  for (const record::SutInfo& sut : record.header.suts) {
    const std::vector<const record::Battery*> own = batteries_of(sut.uav, record);
    if (own.empty()) continue;
    UavEnergy energy{.uav = sut.uav,
                     .spent_J = between(*own.front(), *own.back()),
                     .charge_from = own.front()->charge,
                     .charge_to = own.back()->charge,
                     .least_voltage_V = own.front()->voltage_V};
    for (const record::Battery* battery : own) {
      energy.least_voltage_V = std::min(energy.least_voltage_V, battery->voltage_V);
      if (draws_always(sut) && battery->current_A == 0.0 && battery->at > SimTime{})
        energy.cut_off_at = std::min(energy.cut_off_at, battery->at);
    }
    for (const judge::TaskSpan& task : tasks)
      if (task.uav == sut.uav)
        energy.tasks.push_back(
            {task.task, between(in_effect(own, task.from), in_effect(own, task.to))});
    all.push_back(std::move(energy));
  }
  return all;
}

MetricOutcome energy_j(const scenario::Metric& metric, const record::Record& record) {
  const std::vector<const record::Battery*> own = batteries_of(metric.uav, record);
  if (own.empty()) return missing(fmt::format("the record has no battery of '{}'", metric.uav));
  return {own.back()->spent_j() - own.front()->spent_j(), ""};
}

double total_J(const energy::Energies_J& spent_J) {
  double sum_J = 0.0;
  for (const double cause_J : spent_J) sum_J += cause_J;
  return sum_J;
}

std::optional<double> UavEnergy::more_flights() const {
  const double used = charge_from - charge_to;
  return used > 0.0 ? std::optional(charge_to / used) : std::nullopt;
}

}  // namespace tether::campaign
