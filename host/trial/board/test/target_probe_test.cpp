#include "fake_ssh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/board/target_probe.h>

namespace tether::board {
namespace {

std::vector<std::string> names(const record::Readings& readings) {
  std::vector<std::string> names;
  for (const auto& [name, value] : readings) names.push_back(name);
  return names;
}

TEST(TargetProbe, ReadsTheSameFromThisMachineAndABoard) {
  const FakeSsh ssh;
  const auto here = probe_here(ProbeDepth::kBrief);
  EXPECT_TRUE(here.contains("load_average"));
  EXPECT_EQ(names(probe_board(SshConnection(FakeSsh::address()), ProbeDepth::kBrief)), names(here));
}

TEST(TargetProbe, IsEmptyIfTheConnectionIsLost) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  ssh.scratch().write("ssh", "exit 255\n");
  EXPECT_THAT(probe_board(connection, ProbeDepth::kBrief), testing::IsEmpty());
}

}  // namespace
}  // namespace tether::board
