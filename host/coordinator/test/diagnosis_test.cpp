#include "diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;

Party computing(const std::string& uav, std::int64_t bound_ms, std::int64_t silence_ms) {
  return {.sut = "sut of " + uav,
          .uav = uav,
          .computing = true,
          .bound = ExecTime(milliseconds(bound_ms)),
          .silence = milliseconds(silence_ms)};
}

Party held(const std::string& uav, std::int64_t reply_ms) {
  return {.sut = "sut of " + uav,
          .uav = uav,
          .bound = ExecTime(milliseconds(reply_ms)),
          .reply_at = ExecTime(milliseconds(reply_ms))};
}

const SimTime kSt{milliseconds(1200)};

TEST(Diagnosis, NamesTheOneThatIsLeastFar) {
  EXPECT_EQ(
      who_blocks_whom(kSt, {computing("a", 1300, 10), computing("b", 1200, 1500)}),
      "ST 1.200000 s: blocked on SUT \"sut of b\" (UAV \"b\"), which has been computing for 1.5 s "
      "without a message; last message at ET 1.200000 s");
}

TEST(Diagnosis, NamesThoseThatWaitForIt) {
  EXPECT_THAT(
      who_blocks_whom(kSt, {held("a", 1250), computing("b", 1200, 1500), held("c", 1300)}),
      testing::HasSubstr("(UAV \"a\" waits for its reply of ET 1.250000 s, UAV \"c\" waits for its "
                         "reply of ET 1.300000 s): blocked on SUT \"sut of b\""));
}

TEST(Diagnosis, IsSilentWhereTheSimulatorHasTheWord) {
  EXPECT_EQ(who_blocks_whom(kSt, {held("a", 1250), held("b", 1300)}), "");
  EXPECT_EQ(who_blocks_whom(kSt, {}), "");
}

TEST(Diagnosis, NamesThoseThatHaveNotJoined) {
  EXPECT_EQ(who_has_not_joined({"a"}, milliseconds(1040)),
            "waiting for the SUT of \"a\" to connect (1.0 s so far)");
  EXPECT_EQ(who_has_not_joined({"a", "b"}, milliseconds(2500)),
            "waiting for the SUTs of \"a\", \"b\" to connect (2.5 s so far)");
}

TEST(Diagnosis, SaysWhereAPartyStood) {
  EXPECT_EQ(whereabouts(computing("a", 1250, 10)),
            "it was computing, last heard of at ET 1.250000 s");
  EXPECT_EQ(whereabouts(held("a", 1250)), "it was waiting for its reply of ET 1.250000 s");
}

}  // namespace
}  // namespace tether::coordinator
