#include "errors.h"

#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>

namespace tether::c_api {
namespace {

using testing::HasSubstr;

TEST(LastError, IsOfTheCallingThread) {
  EXPECT_EQ(fail(TETHER_TIMEOUT, "mine"), TETHER_TIMEOUT);
  std::thread([] {
    EXPECT_STREQ(tether_last_error(), "");
    fail(TETHER_INVALID, "yours");
    EXPECT_STREQ(tether_last_error(), "yours");
  }).join();
  EXPECT_STREQ(tether_last_error(), "mine");
}

TEST(LastError, IsCutBetweenCharacters) {
  fail(TETHER_INVALID, std::string(511, 'a'));
  EXPECT_EQ(tether_last_error(), std::string(511, 'a'));
  fail(TETHER_INVALID, std::string(510, 'a') + "\xC3\xA4" + "b");
  EXPECT_EQ(tether_last_error(), std::string(510, 'a'));
  fail(TETHER_INVALID, std::string(509, 'a') + "\xC3\xA4" + "b");
  EXPECT_EQ(tether_last_error(), std::string(509, 'a') + "\xC3\xA4");
}

TEST(StatusName, KnowsEachAndNoOther) {
  for (tether_status status = TETHER_OK; status <= TETHER_INTERNAL; ++status)
    EXPECT_STRNE(tether_status_name(status), "unknown") << status;
  EXPECT_STREQ(tether_status_name(TETHER_OK), "ok");
  EXPECT_STREQ(tether_status_name(TETHER_INTERNAL + 1), "unknown");
  EXPECT_STREQ(tether_status_name(-1), "unknown");
}

TEST(StatusOf, KeepsTheKindAndTheMessage) {
  using Kind = Failure::Kind;
  for (const auto& [kind, status] :
       {std::pair{Kind::kRefused, TETHER_REFUSED},
        std::pair{Kind::kDisconnected, TETHER_DISCONNECTED},
        std::pair{Kind::kProtocol, TETHER_PROTOCOL}, std::pair{Kind::kTimeout, TETHER_TIMEOUT},
        std::pair{Kind::kRunEnded, TETHER_RUN_ENDED}, std::pair{Kind::kInvalid, TETHER_INVALID},
        std::pair{Kind::kNothingYet, TETHER_NOTHING_YET}}) {
    EXPECT_EQ(status_of(Status(Failure{kind, tether_status_name(status)})), status);
    EXPECT_STREQ(tether_last_error(), tether_status_name(status));
  }
  EXPECT_EQ(status_of(ok_status()), TETHER_OK);
}

TEST(Guarded, LetsNoExceptionOut) {
  EXPECT_EQ(guarded([]() -> tether_status { throw std::bad_alloc(); }), TETHER_NO_MEMORY);
  EXPECT_EQ(guarded([]() -> tether_status { throw std::logic_error("a fault"); }), TETHER_INTERNAL);
  EXPECT_STREQ(tether_last_error(), "a fault");
  EXPECT_EQ(guarded([] { return tether_status{TETHER_TIMEOUT}; }), TETHER_TIMEOUT);
}

/// Callers that were compiled with a later header: their struct is larger.
TEST(Put, ClearsMembersOfALaterVersion) {
  struct {
    tether_range_sample known;
    double later = 5.0;
  } out;
  ASSERT_TRUE(can_take(&out.known, sizeof out));
  put(tether_range_sample{1, 2, 3.0}, &out.known, sizeof out);
  EXPECT_EQ(out.known.index, 2u);
  EXPECT_EQ(out.known.range_m, 3.0);
  EXPECT_EQ(out.later, 0.0);
}

TEST(CanTake, RefusesWhatIsTooSmall) {
  tether_range_sample out{1, 2, 3.0};
  EXPECT_FALSE(can_take(&out, sizeof out - 1));
  EXPECT_THAT(tether_last_error(), HasSubstr("sizeof *out"));
  EXPECT_EQ(out.index, 2u);
  EXPECT_FALSE(can_take<tether_range_sample>(nullptr, sizeof out));
  EXPECT_THAT(tether_last_error(), HasSubstr("NULL"));
}

/// This library is the first: nothing has grown yet.
TEST(FirstSize, IsCurrentSize) {
  EXPECT_EQ(kFirstSize<tether_camera_model>, sizeof(tether_camera_model));
  EXPECT_EQ(kFirstSize<tether_image_info>, sizeof(tether_image_info));
  EXPECT_EQ(kFirstSize<tether_imu_sample>, sizeof(tether_imu_sample));
  EXPECT_EQ(kFirstSize<tether_range_sample>, sizeof(tether_range_sample));
  EXPECT_EQ(kFirstSize<tether_navsat_sample>, sizeof(tether_navsat_sample));
  EXPECT_EQ(kFirstSize<tether_magnetometer_sample>, sizeof(tether_magnetometer_sample));
  EXPECT_EQ(kFirstSize<tether_barometer_sample>, sizeof(tether_barometer_sample));
  EXPECT_EQ(kFirstSize<tether_odometry_sample>, sizeof(tether_odometry_sample));
  EXPECT_EQ(kFirstSize<tether_joint_state_sample>, sizeof(tether_joint_state_sample));
  EXPECT_EQ(kFirstSize<tether_scan_model>, sizeof(tether_scan_model));
  EXPECT_EQ(kFirstSize<tether_scan_info>, sizeof(tether_scan_info));
}

}  // namespace
}  // namespace tether::c_api
