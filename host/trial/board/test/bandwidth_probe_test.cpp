#include "fake_ssh.h"

#include <gtest/gtest.h>

#include <tether/board/target_probe.h>

namespace tether::board {
namespace {

TEST(BandwidthProbe, MeasuresRoundTripAndBandwidth) {
  const FakeSsh ssh;
  const auto measured = probe_bandwidth(SshConnection(FakeSsh::address()));
  ASSERT_TRUE(measured);
  EXPECT_GT(measured->round_trip_s, 0.0);
  EXPECT_GT(measured->to_board_MB_s, 0.0);
}

}  // namespace
}  // namespace tether::board
