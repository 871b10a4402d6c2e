// Properties of every key of a profile, whichever it is: the full profile is changed at one key at
// a time.
#include "full_profile.h"
#include "full_scenario.h"
#include "key_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/profile.h>

namespace tether::scenario {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

class ProfileKeys : public testing::Test {
 protected:
  std::string error_with(const KeyLine& key, const std::string& line) const {
    return bad_file_message([&] { load_with(key, line); });
  }
  Profile load_with(const KeyLine& key, const std::string& line) const {
    return load_profile(scratch_.write("p.toml", with_line(kFullProfile, key.line, line)));
  }
  std::string at_line(int line) const {
    const std::string file = scratch_.path("p.toml").string();
    return line == 0 ? file + ": " : file + ":" + std::to_string(line) + ": ";
  }
  ScratchFolder scratch_;
  const std::vector<KeyLine> keys_ = key_lines(kFullProfile);
};

TEST_F(ProfileKeys, AMisspelledKeyIsNamedAtItsLine) {
  for (const KeyLine& key : keys_) {
    SCOPED_TRACE(key.key);
    const std::string message = error_with(key, key.key + "q = " + key.value);
    EXPECT_THAT(message, StartsWith(at_line(key.line) + "unknown key '" + key.key + "q'"));
    EXPECT_THAT(message, HasSubstr("'" + key.key + "'"));
  }
}

TEST_F(ProfileKeys, AValueOfTheWrongTypeIsNamedAtItsLine) {
  for (const KeyLine& key : keys_) {
    SCOPED_TRACE(key.key);
    const std::string message = error_with(key, key.key + " = 1979-05-27");
    EXPECT_THAT(message, StartsWith(at_line(key.line) + "'" + key.key + "' of "));
    EXPECT_THAT(message, HasSubstr(", but is a date or time"));
  }
}

TEST_F(ProfileKeys, ANumberOutOfAnyRangeIsNamedAtItsLine) {
  int numbers = 0;
  for (const KeyLine& key : keys_) {
    if (key.value.find_first_not_of("-0123456789.") != std::string::npos) continue;
    ++numbers;
    for (const std::string value : {"inf", "nan", "-1e300", "1e300"}) {
      SCOPED_TRACE(key.key + " = " + value);
      const std::string message = error_with(key, key.key + " = " + value);
      EXPECT_THAT(message, StartsWith(at_line(key.line) + "'" + key.key + "' of "));
      EXPECT_THAT(message, HasSubstr("must be "));
    }
  }
  EXPECT_EQ(numbers, 22);
}

// A missing key is either not needed, or named at the header of its table.
TEST_F(ProfileKeys, AMissingKeyIsNamedAtItsTable) {
  int optional_keys = 0;
  for (const KeyLine& key : keys_) {
    SCOPED_TRACE(key.key + " of line " + std::to_string(key.line));
    try {
      load_with(key, "");
      ++optional_keys;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), StartsWith(at_line(key.header)));
      EXPECT_THAT(error.what(), HasSubstr("'" + key.key + "'"));
    }
  }
  // All but the name, the kinds, the timings and rates of what is periodic, and the time of a walk.
  EXPECT_EQ(optional_keys, static_cast<int>(keys_.size()) - 9);
}

TEST_F(ProfileKeys, AProfileCutAnywhereIsRefusedOrLoaded) {
  for (std::size_t size = 0; size < kFullProfile.size(); size += 5) {
    try {
      load_profile(scratch_.write("p.toml", kFullProfile.substr(0, size)));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    }
  }
}

}  // namespace
}  // namespace tether::scenario
