#include "sample_messages.h"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <tether/record_testing/canonical.h>

namespace tether::record {
namespace {

Record sample() {
  Record record;
  record.header = header();
  record.interactions = {{st_ms(37), 0, sensor_interaction()},
                         {st_ms(40), 2, command_interaction()}};
  record.commands = {{st_ms(41), 4, command_effect()}};
  record.ground_truth = {{st_ms(40), 3, ground_truth()}};
  record.annotations = {{st_ms(38), 1, annotation()}};
  record.stops = {{st_ms(50), 6, stop()}};
  record.contacts = {{st_ms(50), 7, contact()}};
  record.batteries = {{st_ms(40), 8, battery()}};
  record.images = {{st_ms(41), 5, image()}};
  record.footer = footer();
  return record;
}

TEST(Canonical, LeavesOutWallTimeAndHeader) {
  Record changed = sample();
  changed.header.real_time_factor = 99;
  changed.interactions[0].message.wall_at_arrival += Duration(1);
  changed.interactions[0].message.wall_at_release += Duration(1);
  changed.interactions[0].message.previous_link_time.reset();
  changed.stops[0].message.wall += Duration(1);
  changed.footer->wall += Duration(1);
  EXPECT_EQ(canonical(changed), canonical(sample()));
  EXPECT_EQ(canonical(changed, {.arrivals = true}), canonical(sample(), {.arrivals = true}));
}

struct Change {
  const char* what;
  bool is_arrival;
  std::function<void(Record&)> apply;
};

TEST(Canonical, HasEverythingElseButArrivalsOnlyOnRequest) {
  const Change changes[] = {
      {"arrival", true, [](Record& r) { r.interactions[0].message.st_at_arrival += Duration(1); }},
      {"lag", true, [](Record& r) { r.interactions[0].message.lag += Duration(1); }},
      {"annotation's arrival", true, [](Record& r) { r.annotations[0].at += Duration(1); }},
      {"stop's arrival", true, [](Record& r) { r.stops[0].at += Duration(1); }},
      {"largest lag", true, [](Record& r) { r.footer->largest_lag += Duration(1); }},
      {"request", false, [](Record& r) { r.interactions[0].message.request_at += Duration(1); }},
      {"reply", false, [](Record& r) { r.interactions[0].message.reply_at += Duration(1); }},
      {"release", false, [](Record& r) { r.interactions[0].message.st_at_release += Duration(1); }},
      {"log time", false, [](Record& r) { r.interactions[0].at += Duration(1); }},
      {"one less", false, [](Record& r) { r.interactions.pop_back(); }},
      {"command", false, [](Record& r) { r.commands[0].message.vx_H_m_s = 0.2; }},
      {"last bit", false,
       [](Record& r) { r.ground_truth[0].message.p_WB_m[0] = std::nextafter(1.0 / 3.0, 1); }},
      {"annotation", false, [](Record& r) { r.annotations[0].message.json = "{}"; }},
      {"stop", false, [](Record& r) { r.stops[0].message.at += Duration(1); }},
      {"contact", false, [](Record& r) { r.contacts[0].message.with = "a"; }},
      {"image", false, [](Record& r) { r.images[0].message.png[4] ^= 1; }},
      {"overshoot", false, [](Record& r) { r.footer->largest_overshoot += Duration(1); }},
      {"end", false, [](Record& r) { r.footer->end = "time_limit"; }},
      {"no end", false, [](Record& r) { r.footer.reset(); }},
  };
  for (const Change& change : changes) {
    Record changed = sample();
    change.apply(changed);
    EXPECT_EQ(canonical(changed) == canonical(sample()), change.is_arrival) << change.what;
    EXPECT_NE(canonical(changed, {.arrivals = true}), canonical(sample(), {.arrivals = true}))
        << change.what;
  }
}

// Replies to two SUTs at one ST may leave in either order.
TEST(Canonical, DoesNotDependOnTheOrderBetweenUavs) {
  Record swapped = sample();
  std::swap(swapped.interactions[0], swapped.interactions[1]);
  EXPECT_EQ(canonical(swapped), canonical(sample()));
}

}  // namespace
}  // namespace tether::record
