#include "altered_record.h"
#include "record_generator.h"

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;

constexpr Duration kOffset{-3'000'000};

bool has_image(const Interaction& m) {
  return m.sensor == "camera" && m.sampled_at;
}

// The cameras stamp with a clock that is 3 ms behind and gains 1 ms in 10 s.
Record stamped_record(const record::DriverInfo& driver = {.stamp_offset = kOffset,
                                                          .stamp_drift_ppb = 100'000}) {
  Record record = generate({});
  for (record::SensorInfo& sensor : record.header.sensors)
    if (sensor.name == "camera") sensor.driver = driver;
  for (Entry& entry : record.interactions) {
    Interaction& m = entry.message;
    if (!has_image(m)) continue;
    const Duration gained(to_ns(*m.sampled_at) / 10'000);
    m.sample_stamp = std::max(SimTime(), *m.sampled_at + kOffset + gained);
  }
  return record;
}

TEST(Stamps, AcceptsThoseOfTheDriverInTheHeader) {
  const Verdict verdict = audit(stamped_record());
  EXPECT_TRUE(verdict.findings.empty()) << verdict.findings.front().what;
}

const Planted kStampFaults[] = {
    {"late", {0}, [](Record& r) { *where(r, has_image).sample_stamp += kNs; }},
    {"missing", {0}, [](Record& r) { where(r, has_image).sample_stamp.reset(); }},
    {"without_driver",
     {0},
     [](Record& r) {
       for (record::SensorInfo& sensor : r.header.sensors) sensor.driver.reset();
     }},
    {"probability_of_one",
     {0},
     [](Record& r) {
       for (record::SensorInfo& sensor : r.header.sensors)
         if (sensor.driver) sensor.driver->lost_probability = 1.0;
     }},
    {"lost_samples",
     {1},
     [](Record& r) {
       for (record::SensorInfo& sensor : r.header.sensors)
         if (sensor.driver) sensor.driver->lost_probability = 0.5;
     }},
    {"repeated_samples_with_their_own_content",
     {1},
     [](Record& r) {
       for (record::SensorInfo& sensor : r.header.sensors)
         if (sensor.driver) sensor.driver->repeated_probability = 0.5;
     }},
    {"content_of_another", {1}, [](Record& r) { where(r, has_image).repeated_index = 0; }},
};

class PlantedStamps : public testing::TestWithParam<Planted> {};

TEST_P(PlantedStamps, IsFound) {
  Record record = stamped_record();
  GetParam().plant(record);
  EXPECT_EQ(rules_of(record), GetParam().rules);
}

INSTANTIATE_TEST_SUITE_P(All, PlantedStamps, testing::ValuesIn(kStampFaults),
                         [](const auto& fault) { return std::string(fault.param.what); });

}  // namespace
}  // namespace tether::audit
