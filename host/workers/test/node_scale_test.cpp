#include "fake_cluster.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::workers {
namespace {

class NodeScale : public testing::Test {
 protected:
  double scale(const std::string& node, double ms, bool scales = false) {
    const auto round = create_round(
        fake_.folder, ++rounds_, {.measures_nodes = true, .scales_nodes = scales}, fake_.items());
    WorkerSetup setup = fake_.worker(node + std::to_string(rounds_), node);
    setup.measure_ms = [&, ms] { return ++measured_, ms; };
    return node_scale(*round, setup);
  }
  FakeCampaign fake_;
  std::size_t rounds_ = 0;
  int measured_ = 0;
};

TEST_F(NodeScale, TakesNodesOfOneSpeedAsTheyAre) {
  EXPECT_EQ(scale("n1", 20.0), 1.0);
  EXPECT_EQ(scale("n2", 22.0), 1.0);
  EXPECT_EQ(scale("n3", 18.0), 1.0);
  EXPECT_EQ(scale("n1", 99.0), 1.0);
  EXPECT_EQ(measured_, 3) << "each node once for each campaign";
}

TEST_F(NodeScale, RefusesANodeOfAnotherSpeed) {
  scale("n1", 20.0);
  for (const double ms : {30.0, 15.0}) {
    const std::string node = "n" + std::to_string(static_cast<int>(ms));
    const Error error = thrown_error(ErrorCode::kUsage, [&] { scale(node, ms); });
    EXPECT_EQ(error.subject(), node);
  }
}

TEST_F(NodeScale, ScalesToTheFirstNodeIfThatIsWanted) {
  EXPECT_EQ(scale("n1", 20.0, true), 1.0);
  EXPECT_EQ(scale("n2", 40.0, true), 0.5);
  EXPECT_EQ(scale("n3", 10.0, true), 2.0);
}

TEST_F(NodeScale, AWorkerSaysThatItsNodeIsRefused) {
  scale("n1", 20.0);
  const auto round = create_round(fake_.folder, ++rounds_, {.measures_nodes = true}, fake_.items());
  WorkerSetup setup = fake_.worker("w", "n9");
  setup.measure_ms = [] { return 90.0; };
  thrown_error(ErrorCode::kUsage, [&] { work(*round, setup); });
  EXPECT_TRUE(read_workers(*round).at("w").is_refused);
  EXPECT_TRUE(fake_.flown.empty());
}

}  // namespace
}  // namespace tether::workers
