#include "coordinator_fixture.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

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

}  // namespace
}  // namespace tether::coordinator
