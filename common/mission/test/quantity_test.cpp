#include <set>

#include <gmock/gmock.h>

#include <tether/mission/mission.h>

namespace tether::mission {
namespace {

TEST(Quantity, HasAUniqueNameAndAUnit) {
  std::set<std::string_view> names;
  for (const Quantity& quantity : quantities()) {
    EXPECT_TRUE(names.insert(quantity.name).second) << quantity.name;
    EXPECT_EQ(find_quantity(quantity.name), &quantity);
    EXPECT_THAT(units(),
                ::testing::Contains(::testing::Field(&Unit::dimension, quantity.dimension)));
  }
  EXPECT_EQ(find_quantity("height"), nullptr);
}

}  // namespace
}  // namespace tether::mission
