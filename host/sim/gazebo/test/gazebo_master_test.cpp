#include "gazebo_master.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class GazeboMaster : public testing::Test {
 protected:
  ~GazeboMaster() override { unsetenv("GAZEBO_MASTER_URI"); }

  /// What is said of it; empty: it is taken as it is.
  static std::string refusal_of(const std::string& uri) {
    setenv("GAZEBO_MASTER_URI", uri.c_str(), 1);
    try {
      EXPECT_EQ(master_of_user(), uri);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kSetup);
      return error.what();
    }
    return {};
  }
};

TEST_F(GazeboMaster, NeedNotBeSet) {
  unsetenv("GAZEBO_MASTER_URI");
  EXPECT_EQ(master_of_user(), "");
  EXPECT_EQ(refusal_of(""), "");
}

TEST_F(GazeboMaster, MayBeThisMachine) {
  char name[256] = {};
  ASSERT_EQ(gethostname(name, sizeof name - 1), 0);
  for (const std::string host : {"localhost", "127.0.0.1", static_cast<const char*>(name)})
    EXPECT_EQ(refusal_of("http://" + host + ":11345"), "");
}

TEST_F(GazeboMaster, MayNotBeAnother) {
  // Addresses for documentation: RFC 5737, RFC 2606.
  for (const std::string uri : {"http://192.0.2.1:11345", "http://gazebo.example:11345"})
    EXPECT_THAT(refusal_of(uri),
                AllOf(HasSubstr("GAZEBO_MASTER_URI is \"" + uri + "\", another machine"),
                      HasSubstr("unset it")));
}

TEST_F(GazeboMaster, MustBeAUriWithAPort) {
  for (const std::string uri : {"foo", "localhost:11345", "http://localhost", "http://:1",
                                "http://localhost:", "http://localhost:0", "http://localhost:65536",
                                "http://localhost:1x", "https://localhost:1"})
    EXPECT_THAT(refusal_of(uri),
                HasSubstr("GAZEBO_MASTER_URI is \"" + uri + "\", which is not http://HOST:PORT"));
}

}  // namespace
}  // namespace tether::sim
