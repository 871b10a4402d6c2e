#include "gazebo_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// As Gazebo 11.1 writes it, colours and all.
const std::string kStart =
    "Gazebo multi-robot simulator, version 11.1.0\n"
    "http://gazebosim.org\n\n"
    "\x1b[1;32m[Msg] \x1b[0m\x1b[1;32mWaiting for master.\x1b[0m\x1b[1;32m\n"
    "\x1b[0m\x1b[1;33m[Wrn] [Publisher.cc:136] \x1b[0m\x1b[1;33mQueue limit reached\x1b[0m\n";
const std::string kPort =
    "\x1b[1;31m[Err] [Master.cc:95] \x1b[0m\x1b[1;31mEXCEPTION: \x1b[0m\x1b[1;31mUnable to start "
    "server[bind: Address already in use]. \n\x1b[1;31m\n";
const std::string kTooNew =
    "\x1b[1;31mError [Converter.cc:113]\x1b[0m Unable to convert from SDF version 1.9 to 1.7\n";

using Writer = GazeboLog::Writer;

void expect_last(const std::string& log, Writer writer, const std::string& line) {
  EXPECT_EQ(parse_gazebo_log(log).last_line, line);
  EXPECT_EQ(parse_gazebo_log(log).last_writer, writer) << line;
}

TEST(GazeboLog, HasTheLastLineThatIsAboutTheEnd) {
  expect_last(kStart, Writer::kGazebo, "http://gazebosim.org");
  expect_last(
      kStart + kPort + kStart.substr(kStart.find("\x1b")), Writer::kGazebo,
      "[Err] [Master.cc:95] EXCEPTION: Unable to start server[bind: Address already in use].");
  expect_last("", Writer::kGazebo, "");
  expect_last("the last one, cut sho", Writer::kGazebo, "the last one, cut sho");
  expect_last(kTooNew, Writer::kSdfReader,
              "Error [Converter.cc:113] Unable to convert from SDF version 1.9 to 1.7");
  expect_last(
      "tether: no wheels\n"
      "ALSA lib confmisc.c:767:(parse_card) cannot find card '0'\n"
      "AL lib: (EE) ALCplaybackAlsa_open: Could not open playback\n",
      Writer::kPlugin, "no wheels");
}

TEST(GazeboLog, HasAPortInUse) {
  EXPECT_FALSE(parse_gazebo_log(kStart).has_port_in_use);
  EXPECT_TRUE(parse_gazebo_log(kStart + kPort).has_port_in_use);
}

std::string plugin_line(const std::string& plugin) {
  return "\x1b[1;31m[Err] [Plugin.hh:178] \x1b[0m\x1b[1;31mFailed to load plugin "
         "\x1b[0m\x1b[1;31m" +
         plugin + "\x1b[0m\x1b[1;31m: \x1b[0m\x1b[1;31m" + plugin + ": file too short\x1b[0m\n";
}

TEST(GazeboLog, HasTheFirstWholeLineOfAPluginError) {
  const auto error = [](const std::string& log) { return parse_gazebo_log(log).plugin_error; };
  EXPECT_EQ(error(kStart), "");
  EXPECT_EQ(error(kStart + "[Err] [Plugin.hh:178] Failed to load plugin libw"), "");
  EXPECT_EQ(error(plugin_line("libworld.so") + plugin_line("/lib/a.so")),
            "Failed to load plugin libworld.so: libworld.so: file too short");
  EXPECT_EQ(error("[Err] [Plugin.hh:195] Failed to resolve RegisterPlugin: no symbol\n"),
            "Failed to resolve RegisterPlugin: no symbol");
}

TEST(GazeboLog, HasADrawingErrorWithThatOfTheDriver) {
  const auto error = [](const std::string& log) { return parse_gazebo_log(log).drawing_error; };
  const std::string gl =
      "libGL error: MESA-LOADER: failed to open swrast\nlibGL error: failed to load driver: "
      "swrast\n";
  EXPECT_EQ(error(kStart + gl), "");
  EXPECT_EQ(
      error(kStart + gl + "X Error of failed request:  GLXBadContext\n  Major opcode\n"),
      "libGL error: failed to load driver: swrast; X Error of failed request:  GLXBadContext");
  EXPECT_EQ(error("\x1b[1;33m[Wrn] [RenderEngine.cc:87] \x1b[0mUnable to create X window. "
                  "Rendering will be disabled\n"),
            "[Wrn] [RenderEngine.cc:87] Unable to create X window. Rendering will be disabled");
}

std::vector<std::string> reading_errors(const std::string& log) {
  return parse_gazebo_log(log).reading_errors;
}

TEST(GazeboLog, HasReadingErrorsOnceEach) {
  EXPECT_THAT(reading_errors(kStart + kPort), IsEmpty());
  EXPECT_THAT(reading_errors(kStart + kTooNew + kTooNew +
                             "Error Code 12 Msg: Unable to find uri[model://sun]\n"),
              ElementsAre("Unable to convert from SDF version 1.9 to 1.7",
                          "Unable to find uri[model://sun]"));
  EXPECT_THAT(
      reading_errors(kStart +
                     "\x1b[1;33m[Wrn] [SystemPaths.cc:459] \x1b[0mFile or path does not exist "
                     "[\"\"] [\x1b[0mmeshes/chair.obj\x1b[0m]\x1b[0m\n"
                     "\x1b[1;31m[Err] [Visual.cc:2951] \x1b[0mNo mesh specified\n"),
      ElementsAre(HasSubstr("\"meshes/chair.obj\"")));
  EXPECT_THAT(reading_errors(kStart + "[Wrn] [SystemPaths.cc:459] File or path does not exist "
                                      "[\"\"] [media/fog.material]\n"),
              IsEmpty());
}

// Lines contain names of a world.
TEST(GazeboLog, CutsLinesOfAMegabyte) {
  const std::string name(1'000'000, 'a');
  const auto cut = [](const std::string& line) { return line.substr(0, 2000); };
  for (const std::string& text :
       {name, "\x1b[" + std::string(1'000'000, '1'), std::string(1'000'000, '[')})
    expect_last("[Err] " + text + "\n", Writer::kGazebo, cut("[Err] " + text));
  std::string colours;
  for (int i = 0; i < 100'000; ++i) colours += "\x1b[0m\x1b[1;31m";
  expect_last(colours + "why" + colours, Writer::kGazebo, "why");
  const GazeboLog log = parse_gazebo_log(
      name + " detected an incorrect plugin type\nX Error of failed request: " + name +
      "\nError [Converter.cc:113] " + name + "\nError [" + name +
      "\nFile or path does not exist [\"\"] [" + name + "]\n[Err] No mesh specified\n");
  EXPECT_EQ(log.plugin_error, cut(name));
  EXPECT_EQ(log.drawing_error, cut("X Error of failed request: " + name));
  EXPECT_THAT(log.reading_errors, ElementsAre(cut(name), HasSubstr("\"" + cut(name) + "\"")));
}

}  // namespace
}  // namespace tether::sim
