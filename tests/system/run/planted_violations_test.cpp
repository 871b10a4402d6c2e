#include "support/trials.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether audit` on the record of a real run, altered.
namespace tether::system_test {
namespace {

using record::Interaction;
using record::Record;
using testing::HasSubstr;

constexpr Duration kStep{1'000'000};

/// The record of one run that all cases alter a copy of.
const Record& sound_record() {
  static const Record record = [] {
    const TempFolder folder;
    const Output output =
        run(tether({"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out"}));
    if (output.code != 0) throw std::runtime_error(output.err);
    return read_record(folder / "out");
  }();
  return record;
}

Output audit(const Record& record) {
  const TempFolder folder;
  write_record(folder / "record.mcap", record);
  return run(tether({"audit", folder / "record.mcap"}));
}

/// The 50th or a later interaction of that kind: somewhere in mid-flight.
record::Logged<Interaction>& in_flight(Record& record, std::string_view kind) {
  for (std::size_t i = 50; i < record.interactions.size(); ++i)
    if (record.interactions[i].message.kind == kind) return record.interactions[i];
  throw std::logic_error("no such interaction");
}

void command_a_step_early(Record& record) {
  Interaction& command = in_flight(record, record::kCommand).message;
  *command.effect_at -= kStep;
  for (auto& effect : record.commands) {
    if (effect.message.sequence != command.sequence) continue;
    effect.at -= kStep;
    effect.message.applied_at -= kStep;
  }
}

void effect_removed(Record& record) {
  record.commands.erase(record.commands.begin() + 20);
}

void sample_from_the_future(Record& record) {
  Interaction& reading = in_flight(record, record::kSensor).message;
  const Duration later = 100 * kStep;
  *reading.sampled_at += later;
  *reading.sample_state_at += later;
  *reading.available_at += later;
}

void release_early(Record& record) {
  auto& sleep = in_flight(record, record::kSleep);
  sleep.message.st_at_release -= kStep;
  sleep.at -= kStep;
}

void simulator_ahead_of_its_sut(Record& record) {
  Interaction& sleep = in_flight(record, record::kSleep).message;
  sleep.st_at_arrival = sleep.st_at_release;
  sleep.lag = lag(sleep.request_at, sleep.st_at_arrival);
}

void sequence_gap(Record& record) {
  record.interactions.erase(record.interactions.begin() + 50);
}

void charged_for_waiting(Record& record) {
  auto& command = in_flight(record, record::kCommand).message;
  command.reply_at += Duration(1);
}

void not_stamped(Record& record) {
  in_flight(record, record::kSleep).message.stamped = false;
}

void slept_too_short(Record& record) {
  Interaction& sleep = in_flight(record, record::kSleep).message;
  *sleep.sleep_until += kStep;
}

void miscounted(Record& record) {
  ++record.footer->interactions;
}

struct Planted {
  std::string what;
  std::function<void(Record&)> plant;
  std::string rule;  ///< as the audit names it
};

void PrintTo(const Planted& planted, std::ostream* out) {
  *out << planted.what;
}

const Planted kPlanted[] = {
    {"SampleFromTheFuture", sample_from_the_future, "rule 1"},
    {"CommandAStepEarly", command_a_step_early, "rule 2"},
    {"EffectRemoved", effect_removed, "rule 2"},
    {"ReleaseEarly", release_early, "rule 3"},
    {"SimulatorAheadOfItsSut", simulator_ahead_of_its_sut, "rule 4"},
    {"SequenceGap", sequence_gap, "rule 5"},
    {"ChargedForWaiting", charged_for_waiting, "rule 5"},
    {"NotStamped", not_stamped, "rule 6"},
    {"SleptTooShort", slept_too_short, "rule 7"},
    {"Miscounted", miscounted, "record"},
};

class PlantedViolation : public testing::TestWithParam<Planted> {};

TEST_P(PlantedViolation, FailsTheAuditUnderItsRule) {
  Record record = sound_record();
  GetParam().plant(record);
  const Output output = audit(record);
  EXPECT_EQ(output.code, 1);
  EXPECT_THAT(output.out, HasSubstr("\n  " + GetParam().rule + " (ST "));
}

INSTANTIATE_TEST_SUITE_P(Records, PlantedViolation, testing::ValuesIn(kPlanted),
                         [](const auto& planted) { return planted.param.what; });

TEST(SoundRecord, PassesWhenItIsWrittenAgain) {
  const Output output = audit(sound_record());
  EXPECT_EQ(output.code, 0) << output.out;
  EXPECT_THAT(output.out, HasSubstr("401"));
}

TEST(CutRecord, DoesNotPass) {
  Record record = sound_record();
  record.footer.reset();
  const Output output = audit(record);
  EXPECT_EQ(output.code, 1);
}

TEST(TornFile, IsReadUpToTheTearAndDoesNotPass) {
  const TempFolder folder;
  write_record(folder / "record.mcap", sound_record());
  std::filesystem::resize_file(folder / "record.mcap",
                               std::filesystem::file_size(folder / "record.mcap") / 2);
  const Output output = run(tether({"audit", folder / "record.mcap"}));
  EXPECT_EQ(output.code, 1);
  EXPECT_THAT(output.err, HasSubstr((folder / "record.mcap").string()));
}

}  // namespace
}  // namespace tether::system_test
