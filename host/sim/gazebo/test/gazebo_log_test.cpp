#include "gazebo_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using testing::ElementsAre;
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

TEST(LastWordsOfGazebo, AreNeitherMessagesNorWarnings) {
  EXPECT_EQ(last_words_of_gazebo(kStart), "http://gazebosim.org");
  EXPECT_EQ(
      last_words_of_gazebo(kStart + kPort + kStart.substr(kStart.find("\x1b"))),
      "[Err] [Master.cc:95] EXCEPTION: Unable to start server[bind: Address already in use].");
  EXPECT_EQ(last_words_of_gazebo(""), "");
  EXPECT_EQ(last_words_of_gazebo("the last one, cut sho"), "the last one, cut sho");
}

TEST(LastWordsOfGazebo, LeaveOutWhatIsSaidWithoutASoundCard) {
  EXPECT_EQ(last_words_of_gazebo("gzserver: terminated\n"
                                 "ALSA lib confmisc.c:767:(parse_card) cannot find card '0'\n"
                                 "AL lib: (EE) ALCplaybackAlsa_open: Could not open playback\n"),
            "gzserver: terminated");
}

std::string plugin_line(const std::string& plugin) {
  return "\x1b[1;31m[Err] [Plugin.hh:178] \x1b[0m\x1b[1;31mFailed to load plugin "
         "\x1b[0m\x1b[1;31m" +
         plugin + "\x1b[0m\x1b[1;31m: \x1b[0m\x1b[1;31m" + plugin + ": file too short\x1b[0m\n";
}

TEST(PluginError, IsThatOfAnyPlugin) {
  EXPECT_EQ(plugin_error(kStart), "");
  EXPECT_EQ(plugin_error(kStart + plugin_line("/lib/a.so")),
            "Failed to load plugin /lib/a.so: /lib/a.so: file too short");
  EXPECT_EQ(plugin_error(plugin_line("libworld.so") + plugin_line("/lib/a.so")),
            "Failed to load plugin libworld.so: libworld.so: file too short");
  EXPECT_EQ(plugin_error("[Err] [Plugin.hh:195] Failed to resolve RegisterPlugin: no symbol\n"),
            "Failed to resolve RegisterPlugin: no symbol");
}

TEST(PluginError, IsAWholeLine) {
  EXPECT_EQ(plugin_error(kStart + "[Err] [Plugin.hh:178] Failed to load plugin libw"), "");
}

TEST(DrawingError, IsWhatXlibEndsAProgramWith) {
  const std::string gl =
      "libGL error: MESA-LOADER: failed to open swrast\nlibGL error: failed to load driver: "
      "swrast\n";
  EXPECT_EQ(drawing_error(kStart + gl), "");
  EXPECT_EQ(
      drawing_error(kStart + gl + "X Error of failed request:  GLXBadContext\n  Major opcode\n"),
      "libGL error: failed to load driver: swrast; X Error of failed request:  GLXBadContext");
  EXPECT_EQ(drawing_error("\x1b[1;33m[Wrn] [RenderEngine.cc:87] \x1b[0mUnable to create X window. "
                          "Rendering will be disabled\n"),
            "[Wrn] [RenderEngine.cc:87] Unable to create X window. Rendering will be disabled");
}

TEST(ReadingErrors, AreThoseOfLibsdformatEachOnce) {
  EXPECT_THAT(reading_errors(kStart + kPort), IsEmpty());
  EXPECT_THAT(reading_errors(kStart + kTooNew + kTooNew +
                             "Error Code 12 Msg: Unable to find uri[model://sun]\n"),
              ElementsAre("Unable to convert from SDF version 1.9 to 1.7",
                          "Unable to find uri[model://sun]"));
}

TEST(ReadingErrors, AreMeshesThatGazeboDoesNotFind) {
  EXPECT_THAT(
      reading_errors(kStart +
                     "\x1b[1;33m[Wrn] [SystemPaths.cc:459] \x1b[0mFile or path does not exist "
                     "[\"\"] [\x1b[0mmeshes/chair.obj\x1b[0m]\x1b[0m\n"
                     "\x1b[1;31m[Err] [Visual.cc:2951] \x1b[0mNo mesh specified\n"),
      ElementsAre("it does not find the mesh \"meshes/chair.obj\", and would leave it out: name it "
                  "by a model:// URI"));
  EXPECT_THAT(reading_errors(kStart + "[Wrn] [SystemPaths.cc:459] File or path does not exist "
                                      "[\"\"] [media/fog.material]\n"),
              IsEmpty());
}

// Names of a world stand in its lines.
TEST(LinesOfAMegabyte, AreReadAndCut) {
  const std::string name(1'000'000, 'a');
  const auto cut = [](const std::string& line) { return line.substr(0, 2000); };
  for (const std::string& text :
       {name, "\x1b[" + std::string(1'000'000, '1'), std::string(1'000'000, '[')})
    EXPECT_EQ(last_words_of_gazebo("[Err] " + text + "\n"), cut("[Err] " + text));
  std::string colours;
  for (int i = 0; i < 100'000; ++i) colours += "\x1b[0m\x1b[1;31m";
  EXPECT_EQ(last_words_of_gazebo(colours + "why" + colours), "why");
  EXPECT_EQ(plugin_error(name + "Failed to load plugin " + name + "\n"),
            cut("Failed to load plugin " + name));
  EXPECT_EQ(plugin_error(name + " detected an incorrect plugin type\n"), cut(name));
  EXPECT_EQ(drawing_error("X Error of failed request: " + name),
            cut("X Error of failed request: " + name));
  EXPECT_THAT(reading_errors("Error [Converter.cc:113] " + name + "\nError [" + name + "\n"),
              ElementsAre(cut(name)));
  EXPECT_THAT(reading_errors("File or path does not exist [\"\"] [" + name +
                             "]\n[Err] [Visual.cc:2951] No mesh specified\n"),
              ElementsAre(testing::HasSubstr("the mesh \"" + cut(name) + "\",")));
}

}  // namespace
}  // namespace tether::sim
