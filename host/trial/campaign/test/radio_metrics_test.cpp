#include <gtest/gtest.h>

#include <tether/campaign/metrics.h>

namespace tether::campaign {
namespace {

SimTime at_ms(std::int64_t ms) {
  return SimTime(std::chrono::milliseconds(ms));
}

record::Record traffic(std::vector<record::RadioMessage> messages) {
  record::Record record;
  record.header.policy = record::kConservativeBarrier;
  for (auto& message : messages) record.radio.push_back({message.at, 0, message});
  record.ground_truth.push_back({at_ms(4'000), 0, {}});
  return record;
}

record::RadioMessage message(std::int64_t sent_ms, std::int64_t at, std::string outcome,
                             std::string from = "a", std::string to = "b") {
  return {.uav = std::move(from),
          .sequence = 1,
          .to = std::move(to),
          .bytes = 1,
          .sent_at = at_ms(sent_ms),
          .at = at_ms(at),
          .outcome = std::move(outcome)};
}

MetricValue value(const std::string& kind, const std::string& uav, const record::Record& record) {
  scenario::Metric metric;
  metric.name = metric.kind = kind;
  metric.uav = uav;
  return compute_metrics({&metric, 1}, record).front();
}

TEST(RadioMetrics, DeliveryRatioIsTheShareThatArrived) {
  const auto record = traffic({message(0, 1, "delivered"), message(0, 1, "noise"),
                               message(0, 1, "collision"), message(0, 1, "delivered"),
                               message(0, 1, "waiting"), message(0, 1, "delivered", "b", "a")});
  EXPECT_DOUBLE_EQ(*value("delivery_ratio", "a", record).value, 0.5);
  EXPECT_DOUBLE_EQ(*value("delivery_ratio", "b", record).value, 1.0);
  EXPECT_FALSE(value("delivery_ratio", "c", record).value);
}

// Age 1 s at 1 s, 2 s at 2 s, then 0.5 s, and 2.5 s at 4 s: areas 1.5 and 3 s².
TEST(RadioMetrics, AgeGrowsUntilANewerMessageArrives) {
  const auto record = traffic({message(0, 1'000, "delivered"), message(1'500, 2'000, "delivered"),
                               message(1'000, 3'000, "delivered"), message(2'000, 2'500, "noise")});
  EXPECT_DOUBLE_EQ(*value("age_of_information", "b", record).value, (1.5 + 3.0) / 3.0);
  EXPECT_FALSE(value("age_of_information", "a", record).value);
}

}  // namespace
}  // namespace tether::campaign
