#include "full_scenario.h"
#include "full_target.h"
#include "key_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/target.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class LoadTarget : public testing::Test {
 protected:
  Target load(const std::string& text) const {
    return load_target(scratch_.write("targets/t.toml", text));
  }
  std::string error_of(const std::string& text) const {
    return bad_file_message([&] { load(text); });
  }
  std::string error_with(const std::string& from, const std::string& to) const {
    return error_of(replaced(kFullTarget, from, to));
  }
  ScratchFolder scratch_;
};

TEST_F(LoadTarget, ReadsAVirtualTarget) {
  const Target target = load(kFullTarget);
  EXPECT_EQ(target.file, scratch_.path("targets/t.toml"));
  EXPECT_EQ(target.name, "slow");
  EXPECT_EQ(target.description, "every key");
  EXPECT_FALSE(target.ssh);
  EXPECT_EQ(target.clock, Clock::kCpu);
  EXPECT_EQ(target.cpu_factor, 6.5);
  EXPECT_EQ(target.cores, 2);
}

TEST_F(LoadTarget, FindsItsFilesBesideItself) {
  const Target target = load(kFullTarget);
  EXPECT_THAT(target.launcher, ElementsAre("qemu-aarch64", "-L", scratch_.path("sysroot")));
  EXPECT_EQ(target.program_folder, scratch_.path("arm64/bin"));
  EXPECT_THAT(load("name = \"a\"\nlauncher = [\"./run\", \"a/b\", \"..\"]\n").launcher,
              ElementsAre(scratch_.path("targets/run"), "a/b", ".."));
}

TEST_F(LoadTarget, ReadsABoardAndLeavesItsPathsAlone) {
  const Target target = load(kBoardTarget);
  ASSERT_TRUE(target.ssh);
  EXPECT_EQ(target.ssh->destination, "user@board");
  EXPECT_EQ(target.ssh->port, 2222);
  EXPECT_EQ(target.clock, Clock::kWall);
  EXPECT_THAT(target.launcher, ElementsAre("nice", "-n", "-5", "./wrap"));
  EXPECT_EQ(target.program_folder, "bin");
}

TEST_F(LoadTarget, IsThisHostByDefault) {
  const Target target = load("name = \"bare\"\n");
  EXPECT_EQ(target.clock, Clock::kWall);
  EXPECT_EQ(target.cpu_factor, 1.0);
  EXPECT_EQ(target.cores, 0);
  EXPECT_TRUE(target.launcher.empty());
  EXPECT_EQ(target.program_folder, "");
}

TEST_F(LoadTarget, RefusesWhatIsNoTarget) {
  EXPECT_THAT(error_of(""), HasSubstr("t.toml: the file lacks the key 'name'"));
  EXPECT_THAT(error_with("\"slow\"", "\"my board\""),
              HasSubstr("t.toml:1: 'name' of the file must be 1 to 64 letters"));
  EXPECT_THAT(error_with("\"slow\"", "\"-_-\""), HasSubstr("must contain a letter or a digit"));
  EXPECT_THAT(
      error_with("\"cpu\"", "\"scripted\""),
      HasSubstr("t.toml:3: 'clock' of the file is \"scripted\"; Allowed: 'wall' and 'cpu'"));
  EXPECT_THAT(error_with("cores = 2", "cores = 0"), HasSubstr("must be at least 1"));
  EXPECT_THAT(error_with("cpu_factor = 6.5", "cpu_factor = 0"), HasSubstr("must be at least"));
  EXPECT_THAT(error_with("[\"qemu-aarch64\", \"-L\", \"../sysroot\"]", "[]"),
              HasSubstr("t.toml:6: 'launcher' of the file must name a program"));
  EXPECT_THAT(bad_file_message([&] { load_target(scratch_.path("none.toml")); }),
              HasSubstr("none.toml: there is no such file"));
}

TEST_F(LoadTarget, RefusesAnAddressThatIsNone) {
  for (const std::string address : {"board", "ssh://", "http://board"}) {
    EXPECT_THAT(error_of("name = \"a\"\naddress = \"" + address + "\"\n"),
                HasSubstr("t.toml:2: 'address' of the file is \"" + address + "\"; "));
  }
}

TEST_F(LoadTarget, RefusesToMakeABoardAVirtualTarget) {
  EXPECT_THAT(error_of(kBoardTarget + "clock = \"cpu\"\n"),
              HasSubstr("t.toml:5: 'clock' of the file is \"cpu\", which is for virtual targets"));
  EXPECT_THAT(error_of(kBoardTarget + "cpu_factor = 2\n"),
              HasSubstr("t.toml:5: 'cpu_factor' of the file makes a virtual target"));
  EXPECT_THAT(error_of(kBoardTarget + "cores = 2\n"), HasSubstr("t.toml:5: 'cores'"));
  EXPECT_EQ(load(kBoardTarget + "clock = \"wall\"\n").clock, Clock::kWall);
}

// Properties of every key, whichever it is: one of them is changed at a time.

TEST_F(LoadTarget, AMisspelledKeyIsNamedAtItsLine) {
  for (const std::string& text : {kFullTarget, kBoardTarget}) {
    for (const KeyLine& key : key_lines(text)) {
      SCOPED_TRACE(key.key);
      const std::string message = error_of(with_line(text, key.line, key.key + "q = " + key.value));
      EXPECT_THAT(message,
                  StartsWith(scratch_.path("targets/t.toml").string() + ":" +
                             std::to_string(key.line) + ": unknown key '" + key.key + "q'"));
      EXPECT_THAT(message, HasSubstr("did you mean '" + key.key + "'?"));
    }
  }
}

TEST_F(LoadTarget, AValueOfTheWrongTypeIsNamedAtItsLine) {
  for (const std::string& text : {kFullTarget, kBoardTarget}) {
    for (const KeyLine& key : key_lines(text)) {
      SCOPED_TRACE(key.key);
      const std::string message = error_of(with_line(text, key.line, key.key + " = 1979-05-27"));
      EXPECT_THAT(message, HasSubstr("t.toml:" + std::to_string(key.line) + ": '" + key.key + "'"));
      EXPECT_THAT(message, HasSubstr(", but is a date or time"));
    }
  }
}

TEST_F(LoadTarget, NeedsItsNameOnly) {
  for (const KeyLine& key : key_lines(kFullTarget)) {
    const std::string text = with_line(kFullTarget, key.line, "");
    if (key.key == "name") {
      EXPECT_THAT(error_of(text), HasSubstr("lacks the key 'name'"));
    } else {
      EXPECT_EQ(load(text).name, "slow") << key.key;
    }
  }
}

TEST_F(LoadTarget, AFileCutAnywhereIsRefusedOrLoaded) {
  for (std::size_t size = 0; size < kFullTarget.size(); ++size) {
    try {
      load(kFullTarget.substr(0, size));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    }
  }
}

}  // namespace
}  // namespace tether::scenario
