#include "tables/radio_table.h"

#include <gmock/gmock.h>

namespace tether::report {
namespace {

using testing::ElementsAre;

record::Logged<record::RadioMessage> message(std::string from, std::string to, std::string outcome,
                                             std::int64_t delay_us) {
  const SimTime sent{std::chrono::seconds(1)};
  return {sent,
          0,
          {.uav = std::move(from),
           .sequence = 1,
           .to = std::move(to),
           .bytes = 1,
           .sent_at = sent,
           .at = sent + std::chrono::microseconds(delay_us),
           .outcome = std::move(outcome),
           .distance_m = 2.5}};
}

TEST(RadioTable, HasARowForEachLink) {
  record::Record record;
  EXPECT_TRUE(radio_table(record).rows.empty());
  record.radio = {message("a", "b", "delivered", 1'000), message("a", "b", "delivered", 3'000),
                  message("a", "b", "noise", 9'000), message("a", "b", "queue_full", 0),
                  message("b", "a", "waiting", 0)};
  const Table table = radio_table(record);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_THAT(table.rows[0], ElementsAre("a", "b", "1 noise, 1 queue full", "4", "50.0", "2.000",
                                         "3.000", "2.500"));
  EXPECT_EQ(table.rows[1][2], "none");
  EXPECT_EQ(table.rows[1][4], "–") << "it was on its way";
}

}  // namespace
}  // namespace tether::report
