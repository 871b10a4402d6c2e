#include "plots/radio_lanes.h"

#include <string>

#include <gmock/gmock.h>
#include <tinyxml2.h>

namespace tether::report {
namespace {

using testing::HasSubstr;

struct Drawn {
  int arrived = 0, lost = 0;  // columns, without those of the legend
  std::string texts;
};

Drawn drawn(const record::Record& record) {
  Drawn found;
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(radio_lanes(record).c_str()), tinyxml2::XML_SUCCESS);
  for (const auto* e = document.RootElement()->FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    if (e->Name() == std::string("text")) found.texts += std::string(e->GetText()) + "|";
    if (e->Name() != std::string("rect") || e->Attribute("width", "12.0") != nullptr) continue;
    found.arrived += e->Attribute("class", "tp-fill-3") != nullptr ? 1 : 0;
    found.lost += e->Attribute("class", "tp-fill-4") != nullptr ? 1 : 0;
  }
  return found;
}

void add(record::Record& record, std::string from, std::string to, int sent_s,
         std::string_view outcome) {
  const SimTime sent{std::chrono::seconds(sent_s)};
  const SimTime at = sent + std::chrono::milliseconds(2);
  record.radio.push_back({at,
                          0,
                          {.uav = std::move(from),
                           .to = std::move(to),
                           .sent_at = sent,
                           .at = at,
                           .outcome = std::string(outcome)}});
}

record::Record of_ten_seconds() {
  record::Record record;
  record.footer.emplace().st_at_end = SimTime(std::chrono::seconds(10));
  return record;
}

TEST(RadioLanes, HasALaneForEachLinkWithWhatArrivedAndWasLost) {
  record::Record record = of_ten_seconds();
  EXPECT_EQ(radio_lanes(record), "");
  add(record, "a", "b", 1, record::kDelivered);
  add(record, "a", "b", 1, record::kDelivered);
  add(record, "a", "b", 5, record::kDelivered);
  add(record, "a", "b", 5, "noise");
  add(record, "b", "<a>", 9, record::kWaiting);
  const Drawn picture = drawn(record);
  EXPECT_EQ(picture.arrived, 2) << "one column for those of 1 s";
  EXPECT_EQ(picture.lost, 1);
  EXPECT_THAT(picture.texts, HasSubstr("a → b|75.0 % of 4, 2.0 ms|b → <a>|1 in transit|0|1|2|3|"));
}

TEST(RadioLanes, ShowsThoseOfManyLinksThatLostMost) {
  record::Record record = of_ten_seconds();
  for (int i = 10; i < 40; ++i)
    add(record, "u" + std::to_string(i), "base", 1, i == 35 ? "noise" : record::kDelivered);
  const Drawn picture = drawn(record);
  EXPECT_THAT(picture.texts, HasSubstr("the 24 of 30 links that lost most|"));
  EXPECT_THAT(picture.texts, HasSubstr("u35 → base"));
  EXPECT_EQ(picture.arrived, 23);
  EXPECT_EQ(picture.lost, 1);
}

}  // namespace
}  // namespace tether::report
