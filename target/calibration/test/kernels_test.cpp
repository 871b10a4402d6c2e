#include "kernels.h"

#include <set>
#include <string>

#include <gmock/gmock.h>

namespace tether::calibration {
namespace {

TEST(Kernels, HaveNamesOfTheirOwnAndEnd) {
  std::set<std::string> names;
  for (const Kernel& kernel : kernels()) {
    EXPECT_TRUE(names.insert(kernel.name).second) << kernel.name;
    kernel.run();
  }
}

}  // namespace
}  // namespace tether::calibration
