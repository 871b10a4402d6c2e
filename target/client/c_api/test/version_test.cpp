#include <string>

#include <gmock/gmock.h>

#include <tether/base/version.h>
#include <tether/client.h>

namespace tether::c_api {
namespace {

TEST(Versions, AreThoseOfThisTree) {
  EXPECT_EQ(tether_client_abi_version(), TETHER_CLIENT_ABI_VERSION);
  EXPECT_EQ(tether_client_version(), std::string(version()));
}

}  // namespace
}  // namespace tether::c_api
