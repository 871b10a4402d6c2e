#include <set>

#include <gtest/gtest.h>

#include <tether/mavlink/message.h>

namespace tether::mavlink {
namespace {

// From the generated headers of other implementations.
TEST(MessageType, HasTheExtraChecksumsThatPeersHave) {
  const std::pair<const char*, int> published[] = {
      {"HEARTBEAT", 50},     {"ATTITUDE", 39},         {"LOCAL_POSITION_NED", 185},
      {"COMMAND_LONG", 152}, {"COMMAND_ACK", 143},     {"HIL_SENSOR", 108},
      {"HIL_GPS", 124},      {"PARAM_VALUE", 220},     {"SET_POSITION_TARGET_LOCAL_NED", 143},
      {"TIMESYNC", 34},      {"MISSION_ITEM_INT", 38}, {"STATUSTEXT", 83},
      {"ESC_STATUS", 10},    {"EKF_STATUS_REPORT", 71}};
  for (const auto& [name, crc_extra] : published)
    EXPECT_EQ(find_type(name)->crc_extra, crc_extra) << name;
}

TEST(MessageType, RowsAreInTheOrderOfTheirIdsAndFieldsOfTheirSizes) {
  std::uint32_t last = 0;
  std::set<std::string_view> names;
  for (const MessageType& type : message_types()) {
    EXPECT_TRUE(names.empty() || type.id > last) << type.name;
    EXPECT_TRUE(names.insert(type.name).second);
    EXPECT_LE(type.length, 255U);
    last = type.id;
    EXPECT_EQ(find_type(type.id), &type);
    EXPECT_EQ(find_type(type.name), &type);
    std::size_t size = 8;
    for (const Field& field : type.fields) {
      EXPECT_FALSE(field.name.empty()) << type.name;
      EXPECT_GT(field.count, 0U) << type.name;
      if (field.is_extension) continue;
      EXPECT_LE(size_of(field.type), size) << type.name << " " << field.name;
      size = size_of(field.type);
    }
  }
  EXPECT_GE(names.size(), 80U);
}

TEST(MessageType, KnowsFieldsByTheirNames) {
  const MessageType& type = *find_type("BATTERY_STATUS");
  ASSERT_NE(type.field("voltages"), nullptr);
  EXPECT_EQ(type.field("voltages")->count, 10U);
  EXPECT_EQ(type.field("voltages")->unit, "mV");
  EXPECT_TRUE(type.field("voltages_ext")->is_extension);
  EXPECT_EQ(type.field("nothing"), nullptr);
  EXPECT_EQ(find_type("NOTHING"), nullptr);
  EXPECT_EQ(find_type(99'999U), nullptr);
}

}  // namespace
}  // namespace tether::mavlink
