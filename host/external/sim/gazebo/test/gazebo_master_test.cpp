#include "gazebo_master.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

using testing::HasSubstr;

class GazeboMaster : public testing::Test {
 protected:
  ~GazeboMaster() override { unsetenv("GAZEBO_MASTER_URI"); }
  static std::string master_at(const std::string& uri) {
    setenv("GAZEBO_MASTER_URI", uri.c_str(), 1);
    return master_of_user();
  }
};

TEST_F(GazeboMaster, IsUnsetOrThisMachine) {
  unsetenv("GAZEBO_MASTER_URI");
  EXPECT_EQ(master_of_user(), "");
  EXPECT_EQ(master_at(""), "");
  char name[256] = {};
  ASSERT_EQ(gethostname(name, sizeof name - 1), 0);
  for (const std::string host : {"localhost", "127.0.0.1", static_cast<const char*>(name)})
    EXPECT_EQ(master_at("http://" + host + ":11345"), "http://" + host + ":11345");
}

TEST_F(GazeboMaster, IsNotAnotherMachineOrAnInvalidUri) {
  // Names and addresses for documentation: RFC 5737, RFC 2606.
  for (const std::string uri :
       {"http://192.0.2.1:11345", "http://gazebo.example:11345", "foo", "localhost:11345",
        "http://localhost", "http://:1", "http://localhost:", "http://localhost:0",
        "http://localhost:65536", "http://localhost:1x", "https://localhost:1"}) {
    const Error error = thrown_error(ErrorCode::kSetup, [&] { master_at(uri); });
    EXPECT_EQ(error.subject(), "GAZEBO_MASTER_URI");
    EXPECT_THAT(error.what(), HasSubstr(uri));
  }
}

}  // namespace
}  // namespace tether::sim
