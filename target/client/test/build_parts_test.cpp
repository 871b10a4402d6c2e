#include "build_id.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/link/codec.h>
#include <tether/os/text_file.h>

namespace tether::client {
namespace {

using Parts = std::vector<link::BuildPart>;

std::string value_of(const Parts& parts, const std::string& name) {
  const auto part = std::ranges::find(parts, name, &link::BuildPart::name);
  return part == parts.end() ? "missing" : part->value;
}

TEST(BuildParts, AnArgumentIsItsText) {
  const Parts parts = build_parts({"--fast", "3000000"}, {});
  EXPECT_EQ(value_of(parts, "number of arguments"), "2");
  EXPECT_EQ(value_of(parts, "argument 1"), "--fast");
  EXPECT_EQ(value_of(parts, "argument 2"), "3000000");
}

TEST(BuildParts, AFileThatAnArgumentNamesIsItsContent) {
  const ScratchFolder folder;
  const std::string model = folder.path("net.onnx"), other = folder.path("copy/net.onnx");
  const auto of = [](const std::string& file) {
    return build_parts({file, "--model=" + file}, {});
  };
  std::filesystem::create_directories(folder.path("copy"));
  os::write_file_atomically(model, "1");
  os::write_file_atomically(other, "1");
  EXPECT_EQ(of(model), of(other));  // the folder makes no difference
  os::write_file_atomically(other, "2");
  for (const char* argument : {"argument 1", "argument 2"})
    EXPECT_NE(value_of(of(model), argument), value_of(of(other), argument)) << argument;
}

TEST(BuildParts, AScriptHasTheModulesOfItsFolder) {
  const ScratchFolder folder;
  const std::string script = folder.path("fly.py");
  std::filesystem::create_directories(folder.path("vision"));
  os::write_file_atomically(script, "import vision.detect");
  os::write_file_atomically(folder.path("vision/detect.py"), "n = 1");
  os::write_file_atomically(folder.path("flight.log"), "1");
  const Parts before = build_parts({script}, {});
  EXPECT_NE(value_of(before, "module vision/detect.py"), "missing");
  os::write_file_atomically(folder.path("flight.log"), "2");
  EXPECT_EQ(build_parts({script}, {}), before);
  os::write_file_atomically(folder.path("vision/detect.py"), "n = 2");
  EXPECT_NE(build_parts({script}, {}), before);
}

TEST(BuildParts, ALibraryIsItsBuildIdOrItsContent) {
  const ScratchFolder folder;
  const std::string file = folder.path("libx.so");
  os::write_file_atomically(file, "1");
  const Parts parts = build_parts({}, {{file, ""}, {"/lib/liby.so", "0a"}, {"/opt/liby.so", "0b"}});
  EXPECT_EQ(value_of(parts, "library libx.so"), os::digest_of_file(file));
  EXPECT_EQ(value_of(parts, "library liby.so"), "0a");
  EXPECT_EQ(value_of(parts, "library /opt/liby.so"), "0b");
  EXPECT_FALSE(loaded_libraries().empty());
  for (const LoadedLibrary& library : loaded_libraries())
    EXPECT_NE(library.file.find(".so"), std::string::npos) << library.file;
}

// What does not fit is still compared.
TEST(BuildParts, AreWithinTheLimitsOfHello) {
  std::vector<std::string> many(2000, "7"), lengthy(200, std::string(3000, 'x'));
  for (std::vector<std::string>* arguments : {&many, &lengthy}) {
    link::Hello hello;
    hello.build = build_parts(*arguments, {});
    EXPECT_TRUE(link::validate(hello).ok());
    link::Encoder encoder;
    ASSERT_LE(encoder.encode(hello).size(), link::kMaxHelloBytes);
    const Parts before = hello.build;
    arguments->back().back() = '8';
    EXPECT_NE(build_parts(*arguments, {}), before);
  }
}

TEST(BuildParts, OwnArgumentsAreThoseOfThisProcess) {
  std::vector<std::string> words = testing::internal::GetArgvs();
  words.erase(words.begin());
  EXPECT_EQ(own_arguments(), words);
}

}  // namespace
}  // namespace tether::client
