#include "counted_target.h"

#include "kernels.h"

#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <tether/base/random.h>

namespace tether::calibration {
namespace {

using ::testing::HasSubstr;

constexpr Costs_ns kCostsOfBench_ns = {0.3, 1.1, 7.0, 0.5, 0.4, 0.6, 1.3, 1.7, 0.9, 11.0};
const os::Emulator kEmulator{"qemu-x86_64", "Nehalem", "/root", {}};

/// A machine of these costs, and what it computed.
class CountedTargetTest : public ::testing::Test {
 protected:
  CountedTargetTest() { make_measurement(kCostsOfBench_ns); }

  void make_measurement(const Costs_ns& costs) {
    there_ = counted_ = {};
    KeyedRandom random({.seed = 1, .stream = 2, .index = 3});
    there_.machine.architecture = "x86_64";
    there_.machine.name = "bench";
    for (int i = 0; i < 14; ++i) {
      CountedBlock block{.name = i == 13 ? kWholeStep : "b" + std::to_string(i)};
      if (i == 12) block.name = kChain;  // so short that no cost is below the floor
      for (double& work : block.work) work = (i == 12 ? 1.0 : 1e6) * random.uniform();
      const double ms = 1e-6 * predicted_ns(costs, block);
      auto& measured = i % 2 == 0 && i < 13 ? there_.kernels : there_.blocks;
      auto& counted = i % 2 == 0 && i < 13 ? counted_.kernels : counted_.blocks;
      measured.push_back({block.name, {ms, ms, ms}, {ms, ms, ms}, {}});
      counted.push_back({block.name, {ms}, {ms}, {block.work.begin(), block.work.end()}});
    }
  }

  Calibration there_, counted_;
};

TEST_F(CountedTargetTest, HasTheCostsOfTheMachineAndPredictsTheStepThatIsNotInTheFit) {
  const auto target = fit_target(kEmulator, there_, counted_);
  ASSERT_TRUE(target) << target.failure().message;
  EXPECT_EQ(target->blocks.size(), 13u);
  EXPECT_EQ(target->whole.name, kWholeStep);
  EXPECT_NEAR(relative_error(target->costs, target->whole), 0.0, 1e-6);
  EXPECT_THAT(prediction_table(*target),
              testing::AllOf(HasSubstr("not in the fit"), HasSubstr("No cost is at this bound")));

  const ::toml::table file = ::toml::parse(counted_target_text("bench", *target, there_, counted_));
  EXPECT_EQ(file["clock"].value<std::string>(), "counted");
  EXPECT_EQ(file["emulator"].value<std::string>(), "qemu-x86_64");
  EXPECT_EQ(file["cpu_model"].value<std::string>(), "Nehalem");
  EXPECT_EQ(file["sysroot"].value<std::string>(), "/root");
  for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
    EXPECT_NEAR(file["cost_ns"][kWorkClassNames[kind]].value<double>().value_or(-1.0),
                kCostsOfBench_ns[kind], 1e-4);
}

// A board whose times do not depend on a kind of work.
TEST_F(CountedTargetTest, TakesNoWorkForFreeThatTheTimesDoNotShow) {
  Costs_ns costs = kCostsOfBench_ns;
  costs[static_cast<std::size_t>(WorkClass::kVectorFloat)] = 0.0;
  make_measurement(costs);
  const auto target = fit_target(kEmulator, there_, counted_);
  ASSERT_TRUE(target);
  const double cycle_ns = 1e6 * there_.kernels.back().cpu_ms.front() / kCyclesOfChain;
  EXPECT_DOUBLE_EQ(target->costs[static_cast<std::size_t>(WorkClass::kVectorFloat)], cycle_ns / 4);
  EXPECT_THAT(counted_target_text("bench", *target, there_, counted_),
              HasSubstr("# At this bound, because the blocks do not show more: vector_float.\n"));
}

TEST_F(CountedTargetTest, RefusesOtherBlocks) {
  Calibration older = there_;
  older.kernels.clear();
  EXPECT_THAT(fit_target(kEmulator, older, counted_).failure().message, HasSubstr("\"integers\""));
  older.kernels = {there_.kernels.back()};
  EXPECT_THAT(fit_target(kEmulator, older, counted_).failure().message, HasSubstr("\"b0\""));
  counted_.blocks.front().work.clear();
  EXPECT_FALSE(fit_target(kEmulator, there_, counted_));
}

TEST_F(CountedTargetTest, EmulatesTheMachineThatWasMeasured) {
  EXPECT_EQ(emulator_for({}, there_.machine)->program, "qemu-x86_64");
  CalibrateOptions options;
  options.cpu_model = "max";
  there_.machine.architecture = "aarch64";
  EXPECT_EQ(emulator_for(options, there_.machine)->program, "qemu-aarch64");
  EXPECT_EQ(emulator_for(options, there_.machine)->cpu_model, "max");
  there_.machine.architecture = "riscv64";
  EXPECT_THAT(emulator_for({}, there_.machine).failure().message, HasSubstr("riscv64"));
}

}  // namespace
}  // namespace tether::calibration
