#include "heightmap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Black and bright above, half as bright below.
TEST(Heightmap, IsAsHighAsItsPictureIsBright) {
  const std::string text =
      obj_of_heights({2, 2, {0, 0, 0, 255, 200, 0, 0, 255, 100, 0, 0, 255, 100, 0, 0, 255}});
  EXPECT_THAT(text, StartsWith("v -0.500000 0.500000 0.000000\nvt 0.000000 1.000000\n"
                               "v 0.500000 0.500000 1.000000\n"));
  EXPECT_THAT(text, HasSubstr("v 0.500000 -0.500000 0.500000\nvt 1.000000 0.000000\n"
                              "f 1/1 3/3 2/2\nf 3/3 4/4 2/2\n"));
}

TEST(Heightmap, HasAtMost257HeightsEachWay) {
  const raster::Texture picture{1000, 3, std::vector<std::uint8_t>(4 * 3000, 9)};
  const std::string text = obj_of_heights(picture);
  const std::string last = std::to_string(257 * 3);
  EXPECT_THAT(text, HasSubstr(" " + last + "/" + last + " "));
  EXPECT_THAT(text, Not(HasSubstr(std::to_string(257 * 3 + 1) + "/")));
}

}  // namespace
}  // namespace tether::sim
