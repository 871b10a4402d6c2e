#include "coordinator_fixture.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST_F(CoordinatorTest, RendersOnlyImagesThatAreRead) {
  const RunReport report =
      run({sleep(Duration(0), seconds(10)), read(Duration(0), kCamera), finish(Duration(0))});
  EXPECT_EQ(report.images, 1u);
  EXPECT_EQ(simulator_->calls().measure, 1u);
}

// Those that wait for their instant, and those that are available at the request.
TEST_F(CoordinatorTest, AnnouncesTheImagesOfAllSutsBeforeItsFirstReply) {
  make(3);
  for (const char* uav : {"uav0", "uav1", "uav2"})
    server_->add_sut(hello(uav), {read(milliseconds(1), kCamera), read(milliseconds(23), kCamera),
                                  read(milliseconds(60), kCamera), finish(Duration(1))});
  std::vector<std::size_t> announced;
  simulator_->on_measure(
      [&](std::size_t, std::size_t) { announced.push_back(simulator_->expected().size()); });
  EXPECT_EQ(run().end, RunEnd::kFinished);
  EXPECT_THAT(announced, testing::ElementsAre(3u, 3u, 3u, 6u, 6u, 6u, 9u, 9u, 9u));
}

// Images are 33 ms apart. The SUT gets all of them.
TEST_F(CoordinatorTest, RecordsAllImagesOrThoseOfTheImagePeriod) {
  options_.record_images = true;
  ScriptedServer::Script script;
  for (int i = 0; i < 6; ++i) script.push_back(read(Duration(0), kCamera));
  script.push_back(read(Duration(0), kCamera, true));
  script.push_back(read(Duration(0), kRange));
  script.push_back(finish(Duration(0)));
  const auto recorded = [&](Duration period) {
    options_.image_period = period;
    make();
    EXPECT_EQ(run(script).images, 7u);
    std::vector<std::uint64_t> indices;
    for (const record::Image& image : recorder_.images) indices.push_back(image.index);
    return indices;
  };
  EXPECT_THAT(recorded(Duration(0)), testing::ElementsAre(0u, 1u, 2u, 3u, 4u, 5u, 5u));
  EXPECT_THAT(recorded(milliseconds(66)), testing::ElementsAre(0u, 2u, 4u));
}

// What is seen of the anchors is the truth: the record has it with each read, the SUT does not.
TEST_F(CoordinatorTest, RecordsDepthsLabelsAndWhatIsSeenOfAnchors) {
  using uav::CameraKind;
  options_.record_images = true;
  const std::vector<uav::SeenAnchor> seen{{"box", 1, 2, 3, 4, 5}};
  for (const auto kind : {CameraKind::kColor, CameraKind::kRgbd, CameraKind::kSegmentation}) {
    make();
    simulator_->set_camera_kind(kind);
    simulator_->plan_seen_anchors(seen);
    run({read(Duration(0), kCamera), read(Duration(0), kRange), finish(Duration(0))});
    EXPECT_EQ(recorder_.images.size(), uav::has_color(kind) ? 1U : 0U);
    ASSERT_EQ(recorder_.raw_images.size(), kind == CameraKind::kColor ? 0U : 1U);
    if (kind == CameraKind::kRgbd) {
      EXPECT_EQ(recorder_.raw_images[0].pixels.index(), 0U);
    }
    const auto& of_image = recorder_.interactions.at(0).seen_anchors;
    ASSERT_TRUE(of_image && of_image->size() == 1);
    EXPECT_EQ(of_image->at(0), (record::SeenAnchor{"box", 1, 2, 3, 4, 5}));
    EXPECT_FALSE(recorder_.interactions.at(1).seen_anchors);
  }
}

// ---- The end of a SUT

/// A SUT whose Finish is held until ST is 1 s.
class FinishingTest : public CoordinatorTest {
 protected:
  FinishingTest() {
    make();
    peer_ = add_silent();
    server_->deliver(peer_, request(1, us(1'000'000), link::Finish{true, "done", "{}"}));
  }
  void expect_finished() {
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kFinished) << report.reason;
    EXPECT_EQ(report.st, st_ms(1000));
    EXPECT_EQ(report.suts.at(0).finish->outcome, "done");
    EXPECT_EQ(recorder_.interactions.at(0).kind, record::kFinish);
  }
  link::PeerId peer_ = 0;
};

TEST_F(FinishingTest, ASutThatDisconnectsMeanwhileIsFinished) {
  server_->disconnect(peer_);
  expect_finished();
}

TEST_F(FinishingTest, AHalfClosedConnectionStillGetsItsReply) {
  server_->half_close(peer_);
  expect_finished();
  EXPECT_TRUE(std::holds_alternative<link::Reply>(server_->sent[peer_].back()));
  EXPECT_EQ(server_->closed, std::vector{peer_});
}

TEST_F(FinishingTest, AProtocolViolationMeanwhileIsALoss) {
  server_->deliver(peer_, link::Welcome{});
  server_->disconnect(peer_);
  EXPECT_EQ(run().end, RunEnd::kSutLost);
  EXPECT_EQ(refusal(peer_).reason, link::Refusal::Reason::kBadMessage);
}

TEST_F(CoordinatorTest, AHalfClosedConnectionBeforeTheFinishIsALoss) {
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), seconds(1))});
  server_->half_close(peer);
  EXPECT_EQ(run().end, RunEnd::kSutLost);
}

}  // namespace
}  // namespace tether::coordinator
