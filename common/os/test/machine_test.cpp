#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/os/machine.h>

namespace tether::os {
namespace {

TEST(Machine, IsDescribedByModelCoresAndKernel) {
  EXPECT_THAT(describe_machine(), testing::MatchesRegex(".+, [0-9]+ cores, Linux .+ .+"));
}

TEST(Machine, HasAtLeastTheCoresThatThisProcessMayUse) {
  const auto cpus = allowed_cpus();
  ASSERT_FALSE(cpus.empty());
  EXPECT_TRUE(std::is_sorted(cpus.begin(), cpus.end()));
  EXPECT_GE(machine_cores(), static_cast<int>(cpus.size()));
  EXPECT_GE(separate_cores(), 1);
  EXPECT_LE(separate_cores(), static_cast<int>(cpus.size()));
}

}  // namespace
}  // namespace tether::os
