// Properties of every key of a scenario, whichever it is: the full scenario is changed at one key
// at a time.
#include "full_scenario.h"
#include "key_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ScenarioKeys : public testing::Test {
 protected:
  std::string error_of(const std::string& text) const {
    return bad_file_message([&] { load_scenario(write_project(scratch_, text)); });
  }
  std::string at_line(int line) const {
    const std::string file = scratch_.path("scenario.toml").string();
    return line == 0 ? file + ": " : file + ":" + std::to_string(line) + ": ";
  }
  ScratchFolder scratch_;
};

bool is_parameter(const KeyLine& key) {
  const auto lines = lines_of(kFullScenario);
  const std::string header =
      key.header > 0 ? lines[static_cast<std::size_t>(key.header - 1)] : std::string();
  return header.ends_with("sut.parameters]") || header.ends_with("sut.files]");
}

TEST_F(ScenarioKeys, AMisspelledKeyIsNamedAtItsLine) {
  for (const KeyLine& key : key_lines(kFullScenario)) {
    if (is_parameter(key)) continue;
    SCOPED_TRACE(key.key);
    const std::string message =
        error_of(with_line(kFullScenario, key.line, key.key + "q = " + key.value));
    EXPECT_THAT(message, StartsWith(at_line(key.line) + "unknown key '" + key.key + "q'"));
    EXPECT_THAT(message, HasSubstr("did you mean '" + key.key + "'?"));
  }
}

TEST_F(ScenarioKeys, AValueOfTheWrongTypeIsNamedAtItsLine) {
  for (const KeyLine& key : key_lines(kFullScenario)) {
    SCOPED_TRACE(key.key);
    const std::string message =
        error_of(with_line(kFullScenario, key.line, key.key + " = 1979-05-27"));
    EXPECT_THAT(message, StartsWith(at_line(key.line) + "'" + key.key + "' of "));
    EXPECT_THAT(message, HasSubstr(", but is a date or time"));
  }
}

TEST_F(ScenarioKeys, ANumberOutOfAnyRangeIsNamedAtItsLine) {
  for (const KeyLine& key : key_lines(kFullScenario)) {
    const bool is_number = key.value.find_first_not_of("0123456789.") == std::string::npos;
    if (!is_number || is_parameter(key)) continue;
    for (const std::string value : {"inf", "nan", "-1e300", "1e300"}) {
      SCOPED_TRACE(key.key + " = " + value);
      const std::string message =
          error_of(with_line(kFullScenario, key.line, key.key + " = " + value));
      EXPECT_THAT(message, StartsWith(at_line(key.line) + "'" + key.key + "' of "));
      EXPECT_THAT(message, HasSubstr("must be "));
    }
  }
}

// A missing key is either not needed, or named at the header of its table. ('anchors' is neither:
// without it, the metric that names one of them is wrong.)
TEST_F(ScenarioKeys, AMissingKeyIsNamedAtItsTable) {
  int optional_keys = 0;
  for (const KeyLine& key : key_lines(kFullScenario)) {
    if (key.key == "anchors") continue;
    SCOPED_TRACE(key.key + " of line " + std::to_string(key.line));
    try {
      load_scenario(write_project(scratch_, with_line(kFullScenario, key.line, "")));
      ++optional_keys;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), StartsWith(at_line(key.header)));
      EXPECT_THAT(error.what(), HasSubstr("'" + key.key + "'"));
    }
  }
  EXPECT_EQ(optional_keys, 31);
}

// Whatever the bytes, it is loaded or refused with a reason.
TEST_F(ScenarioKeys, AScenarioCutAnywhereIsRefusedOrLoaded) {
  for (std::size_t size = 0; size < kFullScenario.size(); size += 7) {
    try {
      load_scenario(write_project(scratch_, kFullScenario.substr(0, size)));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    }
  }
}

}  // namespace
}  // namespace tether::scenario
