#include "clocks/counted_source.h"

#include <new>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/base_testing/scratch_folder.h>

namespace tether::client {
namespace {

using ::testing::HasSubstr;

class CountedSource : public ::testing::Test {
 protected:
  /// The page, as the host and the plugin leave it when the program starts.
  os::MappedCounts page() {
    os::MappedCounts mapped = os::map_counts(file_);
    new (mapped.get()) CountPage{};
    mapped->cost_units.fill(75'003);
    mapped->plugin_version.store(CountPage::kVersion);
    return mapped;
  }

  ScratchFolder scratch_;
  std::string file_ = scratch_.write("counts", std::string(sizeof(CountPage), '\0'));
};

TEST_F(CountedSource, TakesTheSameTimeForTheSameWorkWhateverWasCountedBefore) {
  const auto page_of_plugin = page();
  const auto source = source_of(os::map_counts(file_));
  SutClock clock(*source);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    clock.hold();
    page_of_plugin->units += KeyedRandom({.seed = 1, .stream = 2, .index = i}).bits();
    clock.resume(ExecTime{});
    page_of_plugin->units += 11 * 75'003;
    ASSERT_EQ(clock.now(), from_ns<ExecTime>(11 * 75'003 / 100'000)) << i;
  }
}

TEST_F(CountedSource, DoesNotCountWhileTheProgramIsHeld) {
  const auto page_of_plugin = page();
  const auto source = source_of(os::map_counts(file_));
  SutClock clock(*source);
  clock.hold();
  EXPECT_EQ(page_of_plugin->held.load(), 1u);
  page_of_plugin->units += 1'000'000;
  clock.resume(from_ns<ExecTime>(5));
  EXPECT_EQ(page_of_plugin->held.load(), 0u);
  EXPECT_EQ(clock.now(), from_ns<ExecTime>(5));
}

TEST_F(CountedSource, IsNotCompleteIfCountsStandStillOrAfterAFault) {
  const auto page_of_plugin = page();
  const auto source = source_of(os::map_counts(file_));
  EXPECT_EQ(page_of_plugin->watched.load(), 1u);
  EXPECT_EQ(source->complete().failure().kind, Failure::Kind::kInvalid) << "counts stand still";
  page_of_plugin->units += 1;
  EXPECT_TRUE(source->complete());
  for (const CountFault fault : {CountFault::kThreads, CountFault::kProcess, CountFault::kClock}) {
    page_of_plugin->fault.store(static_cast<std::uint32_t>(fault));
    EXPECT_EQ(source->complete().failure().kind, Failure::Kind::kRefused);
  }
}

TEST_F(CountedSource, RefusesAPageThatDoesNotCountThisProgram) {
  const auto reason = [](const std::string& file) {
    const auto source = make_counted_source(file);
    EXPECT_EQ(source.failure().kind, Failure::Kind::kInvalid);
    return source.failure().message;
  };
  EXPECT_THAT(reason(""), HasSubstr("TETHER_COUNTS is not set"));
  EXPECT_THAT(reason(scratch_.path("none")), HasSubstr("cannot be mapped"));
  EXPECT_THAT(reason(file_), HasSubstr("not a page of counts"));
  const auto page_of_plugin = page();
  EXPECT_THAT(reason(file_), HasSubstr("do not advance"));
  page_of_plugin->plugin_version.store(0);
  EXPECT_THAT(reason(file_), HasSubstr("no plugin"));
  page_of_plugin->version = CountPage::kVersion + 1;
  EXPECT_THAT(reason(file_), HasSubstr("not a page of counts"));
  scratch_.write("counts", "short");
  EXPECT_THAT(reason(file_), HasSubstr("cannot be mapped"));
}

}  // namespace
}  // namespace tether::client
