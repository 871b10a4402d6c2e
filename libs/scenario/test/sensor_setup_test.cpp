#include "sensor_setup.h"

#include "full_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class DelaySamples : public testing::Test {
 protected:
  std::string error_of(const std::string& text) const {
    const auto file = scratch_.write("d.txt", text);
    return bad_file_message([&] { (void)read_delay_samples(file, 1e-3); });
  }
  Scratch scratch_;
};

TEST_F(DelaySamples, SkipsBlankLinesAndComments) {
  const auto file = scratch_.write("d.txt", "# measured 2024\r\n\n 0.0374 \r\n  # more\n0\n1e-3");
  EXPECT_THAT(read_delay_samples(file, 1.0),
              ElementsAre(Duration(37'400'000), Duration(0), Duration(1'000'000)));
}

TEST_F(DelaySamples, NamesTheLineOfWhatIsNoDelay) {
  EXPECT_THAT(error_of("1\n2\nthree\n"), HasSubstr("d.txt:3: expected one number"));
  EXPECT_THAT(error_of("1\n2 3\n"), HasSubstr("d.txt:2: expected one number"));
  EXPECT_THAT(error_of("-0.5\n"), HasSubstr("d.txt:1: a delay must be at least 0"));
  EXPECT_THAT(error_of("nan\n"), HasSubstr("d.txt:1: "));
  EXPECT_THAT(error_of("1e9\n"), HasSubstr("at most 60000"));
  EXPECT_THAT(error_of("0x10\n"), HasSubstr("expected one number"));
}

TEST_F(DelaySamples, RefusesAFileWithoutAny) {
  EXPECT_THAT(error_of(""), HasSubstr("holds no delay"));
  EXPECT_THAT(error_of("# nothing\n\n"), HasSubstr("holds no delay"));
}

}  // namespace
}  // namespace tether::scenario
