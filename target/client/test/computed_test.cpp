#include <chrono>
#include <string_view>

#include <gtest/gtest.h>

#include <tether/client/exec/computed.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using namespace std::string_view_literals;

TEST(Computed, DetailsAreJson) {
  EXPECT_EQ(details_of({}), R"({"computed_s": {}})");
  EXPECT_EQ(details_of({{"python3 track.py", 1250ms}, {"a\"b\\\n", 20ms}, {"sleep", 9ms}}),
            R"({"computed_s": {"a?b??": 0.020, "python3 track.py": 1.250}})");
}

TEST(Computed, AProcessIsItsProgramAndItsScript) {
  EXPECT_EQ(process_name("/usr/bin/python3\0/opt/node/track.py\0--fast\0"sv), "python3 track.py");
  EXPECT_EQ(process_name("python3\0-c\0import time\0"sv), "python3");
  EXPECT_EQ(process_name("bash\0run.sh\0"sv), "bash run.sh");
  EXPECT_EQ(process_name("basename\0"
                         "3.11\0"sv),
            "basename");
  EXPECT_EQ(process_name("./companion\0"sv), "companion");
  EXPECT_EQ(process_name("sleep\0"
                         "100\0"sv),
            "sleep");
  EXPECT_EQ(process_name(""), "");
}

}  // namespace
}  // namespace tether::client
