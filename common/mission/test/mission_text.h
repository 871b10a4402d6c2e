#pragma once

#include <string>

#include <tether/base_testing/thrown_error.h>
#include <tether/mission/mission.h>

namespace tether::mission {

/// Lines 1 to 10 of a file: an anchor, and the tasks "find", "fly" and "land".
inline const std::string kTasks = R"(anchor = "blue_box"
[[task]]
task = "search"
name = "find"
[[task]]
task = "go_to"
name = "fly"
[[task]]
task = "land"

)";

inline Mission parsed(const std::string& text) {
  return read_mission(toml::Document::parse(text, "m.toml").root());
}
/// Expects Error(kBadFile) at that line, about that key or name.
inline void expect_refusal(const std::string& text, int line, const std::string& subject) {
  const Error error = bad_file_error([&] { parsed(text); });
  EXPECT_EQ(error.where(), (FileLocation{"m.toml", line})) << error.what();
  EXPECT_EQ(error.subject(), subject) << error.what();
}

}  // namespace tether::mission
