#include "coordinator_fixture.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

TEST_F(CoordinatorTest, FramesThatNobodyReadsAreNeverMeasured) {
  const RunReport report =
      run({sleep(Duration(0), seconds(10)), read(Duration(0), kCamera), finish(Duration(0))});
  EXPECT_EQ(report.images, 1u);
  EXPECT_EQ(simulator_->calls().measure, 1u);
}

// Images are 33 ms apart; what is recorded is thinned, what the SUT gets is not.
TEST_F(CoordinatorTest, RecordsImagesNoOftenerThanAsked) {
  options_.record_images = true;
  options_.image_period = milliseconds(66);
  ScriptedServer::Script script;
  for (int i = 0; i < 6; ++i) script.push_back(read(Duration(0), kCamera));
  script.push_back(read(Duration(0), kCamera, true));
  script.push_back(finish(Duration(0)));
  const RunReport report = run(script);
  EXPECT_EQ(report.images, 7u);
  std::vector<std::uint64_t> indices;
  for (const record::Image& image : recorder_.images) indices.push_back(image.index);
  EXPECT_THAT(indices, testing::ElementsAre(0u, 2u, 4u));
}

TEST_F(CoordinatorTest, RecordsEveryImageThatIsReadUnlessAskedOtherwise) {
  options_.record_images = true;
  run({read(Duration(0), kCamera), read(Duration(0), kCamera), read(Duration(0), kCamera, true),
       read(Duration(0), kRange), finish(Duration(0))});
  EXPECT_EQ(recorder_.images.size(), 3u);
}

// ---- The end of a SUT

link::Request finish_at(ExecTime at) {
  return {.sequence = 1, .issued_at = at, .body = link::Finish{true, "done", "{}"}};
}

/// A SUT whose Finish is held until ST has come to 1 s.
class FinishingTest : public CoordinatorTest {
 protected:
  FinishingTest() {
    make();
    peer_ = server_->add_sut(hello(), {});
    server_->deliver(peer_, finish_at(us(1'000'000)));
  }
  void expect_finished() {
    const RunReport report = coordinator_->run(*server_);
    EXPECT_EQ(report.end, RunEnd::kFinished) << report.reason;
    EXPECT_EQ(report.st, st_ms(1000));
    EXPECT_EQ(report.suts.at(0).finish->outcome, "done");
    EXPECT_EQ(recorder_.interactions.at(0).kind, record::kFinish);
  }
  link::PeerId peer_ = 0;
};

TEST_F(FinishingTest, WhoLeavesMeanwhileHasFinished) {
  server_->disconnect(peer_);
  expect_finished();
}

TEST_F(FinishingTest, WhoSaysNoMoreIsToldStill) {
  server_->half_close(peer_);
  expect_finished();
  EXPECT_TRUE(std::holds_alternative<link::Reply>(server_->sent[peer_].back()));
  EXPECT_EQ(server_->closed, std::vector{peer_});
}

TEST_F(FinishingTest, WhoSaysSomethingElseIsLost) {
  server_->deliver(peer_, link::Welcome{});
  server_->disconnect(peer_);
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("a message that only coordinators send"));
}

TEST_F(CoordinatorTest, ASutThatSaysNoMoreBeforeItsFinishIsLost) {
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), seconds(1))});
  server_->half_close(peer);
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kSutLost);
}

}  // namespace
}  // namespace tether::coordinator
