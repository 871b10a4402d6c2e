#include "fuzz_target.h"

#include <array>

#include <tether/audit/audit.h>
#include <tether/record_testing/canonical.h>

/// The audit, with records that no coordinator writes. Input: the record, field by field; all of a
/// record's numbers may be anything.
namespace tether::fuzz {
namespace {

constexpr std::array<const char*, 4> kNames{"a", "b", "", "c"};
constexpr std::array<std::string_view, 5> kKinds{record::kSensor, record::kCommand, record::kSleep,
                                                 record::kFinish, "other"};

/// Any instant or duration; often one that a record can have.
template <class Time>
Time time(Choices& choices) {
  if constexpr (std::is_same_v<Time, Duration>)
    return Duration(choices.number());
  else
    return from_ns<Time>(choices.number());
}
template <class Time>
std::optional<Time> maybe(Choices& choices) {
  if (choices.coin()) return std::nullopt;
  return time<Time>(choices);
}
std::string name(Choices& choices) {
  return kNames[choices.below(kNames.size())];
}

record::Header header(Choices& choices) {
  record::Header header;
  header.policy = choices.coin() ? record::kConservativeBarrier : record::kFreeRunning;
  header.step = time<Duration>(choices);
  header.ground_truth_period = time<Duration>(choices);
  for (std::size_t i = choices.below(4); i > 0; --i)
    header.suts.push_back({name(choices),
                           "sut",
                           {computer::ClockKind::kCpu},
                           time<Duration>(choices),
                           choices.coin()});
  for (std::size_t i = choices.below(4); i > 0; --i)
    header.sensors.push_back({name(choices), name(choices), "camera", choices.coin(),
                              time<Duration>(choices), time<Duration>(choices),
                              time<Duration>(choices), time<Duration>(choices)});
  for (std::size_t i = 0; i < header.sensors.size(); i += 2)
    header.sensors[i].driver = {header.sensors[i].phase, header.sensors[i].period, -20'000, 0.3,
                                0.2};
  header.reports_contacts = header.suts.size() % 2 == 0;
  return header;
}

record::Interaction interaction(Choices& choices) {
  record::Interaction m;
  m.uav = name(choices);
  m.sequence = static_cast<std::uint64_t>(choices.number());
  m.kind = kKinds[choices.below(kKinds.size())];
  m.request_at = time<ExecTime>(choices);
  m.reply_at = time<ExecTime>(choices);
  m.sensor = name(choices);
  m.sample_index = static_cast<std::uint64_t>(choices.number());
  m.latest = choices.coin();
  m.only_if_available = choices.coin();
  m.sampled_at = maybe<SimTime>(choices);
  m.sample_state_at = maybe<SimTime>(choices);
  m.available_at = maybe<SimTime>(choices);
  m.effect_at = maybe<SimTime>(choices);
  m.sleep_until = maybe<ExecTime>(choices);
  m.st_at_arrival = time<SimTime>(choices);
  m.st_at_release = time<SimTime>(choices);
  m.lag = time<Duration>(choices);
  m.grid_error = time<Duration>(choices);
  m.stamped = choices.coin();
  m.wall_at_arrival = time<WallTime>(choices);
  m.wall_at_release = time<WallTime>(choices);
  if (m.latest) m.sample_stamp = m.available_at;
  if (m.latest && m.stamped) m.repeated_index = m.sequence;
  if (m.only_if_available && m.stamped) m.skipped_to = m.sample_index;
  return m;
}

record::Footer footer(Choices& choices) {
  record::Footer footer;
  footer.end = choices.coin() ? "finished" : "time_limit";
  footer.st_at_end = time<SimTime>(choices);
  for (std::size_t i = choices.below(4); i > 0; --i)
    footer.et_at_end.push_back(time<ExecTime>(choices));
  footer.interactions = static_cast<std::uint64_t>(choices.number());
  footer.largest_lag = time<Duration>(choices);
  footer.largest_grid_error = time<Duration>(choices);
  footer.stops = choices.byte();
  return footer;
}

void add_message(Choices& choices, std::uint64_t order, record::Record& record) {
  const SimTime at = time<SimTime>(choices);
  switch (choices.below(8)) {
    case 0:
      record.commands.push_back(
          {at, order, {name(choices), choices.byte(), time<SimTime>(choices), 1, 2, 3, 4}});
      record.commands.back().message.index = choices.byte();
      if (choices.coin()) record.commands.back().message.loss = "brake";
      if (choices.coin()) record.commands.back().message.setpoint.emplace();
      return;
    case 1:
      return record.ground_truth.push_back({at, order, {name(choices), time<SimTime>(choices)}});
    case 2:
      return record.annotations.push_back(
          {at, order, {name(choices), time<ExecTime>(choices), "roi", "{}"}});
    case 3:
      return record.stops.push_back({at,
                                     order,
                                     {name(choices), time<ExecTime>(choices),
                                      maybe<ExecTime>(choices), time<WallTime>(choices)}});
    case 4:
      return record.contacts.push_back(
          {at, order, {name(choices), time<SimTime>(choices), name(choices), 1.0}});
    default:
      return record.interactions.push_back({at, order, interaction(choices)});
  }
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::Choices choices({data, size});
  record::Record record;
  record.header = fuzz::header(choices);
  if (choices.coin()) record.footer = fuzz::footer(choices);
  for (std::uint64_t order = 0; !choices.empty(); ++order)
    fuzz::add_message(choices, order, record);
  const audit::Verdict verdict = audit::audit(record);
  fuzz::require(verdict.findings.size() <= audit::kMaxFindings, "too many findings");
  (void)audit::to_text(verdict, verdict.findings.size());
  (void)record::canonical(record, {.arrivals = true});
  return 0;
}
