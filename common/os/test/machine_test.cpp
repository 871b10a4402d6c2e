#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

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

TEST(Machine, TellsHowItsProcessorsSpentTheirTime) {
  using namespace std::chrono_literals;
  EXPECT_EQ(parse_processor_time("cpu  54886 36131 14990 19588 895 1 210 607 0 0", 10ms),
            (ProcessorTime{(54'886 + 36'131 + 14'990 + 1 + 210) * Duration(10ms), 6'070ms,
                           (19'588 + 895) * Duration(10ms)}));
  EXPECT_FALSE(parse_processor_time("cpu0 1 2 3 4 5 6 7 8", 10ms));
  EXPECT_FALSE(parse_processor_time("cpu 1 2 3 4", 10ms));
  EXPECT_FALSE(parse_processor_time("", 10ms));
  EXPECT_GT(processor_time()->used, 0s);
}

TEST(Machine, AllowsAsManyDescriptorsAsTheHardLimit) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit few{before.rlim_cur - 10, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  EXPECT_EQ(allow_descriptors(1), few.rlim_cur) << "never fewer";
  EXPECT_EQ(allow_descriptors(before.rlim_cur), before.rlim_cur);
  const rlim_t most = std::min<rlim_t>(before.rlim_max, 1'000'000);
  EXPECT_LE(allow_descriptors(most + 1), before.rlim_max);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

}  // namespace
}  // namespace tether::os
