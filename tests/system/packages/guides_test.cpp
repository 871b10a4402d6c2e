#include "support/installed.h"
#include "support/trials.h"

#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The guides for newcomers, followed to the letter: their files are written, and their commands
/// typed, in an empty folder, with what `cmake --install` installs into an empty home.
namespace tether::system_test {
namespace {

/// A fenced block of a guide, and the file that the line before it names, if it is one.
struct Block {
  std::string language, file, text;
};

std::vector<Block> blocks_of(const std::string& guide) {
  static const std::regex kFile(".*`([A-Za-z0-9_]+\\.[a-z]+)`.*:");
  std::vector<Block> blocks;
  std::istringstream lines(
      read_text(std::filesystem::path(TETHER_SOURCE_DIR) / "docs/guide" / guide));
  std::string before;
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.starts_with("```");
    if (is_fence && !is_inside) {
      std::smatch file;
      blocks.push_back(
          {line.substr(3), std::regex_match(before, file, kFile) ? file[1].str() : "", ""});
    } else if (is_inside && !is_fence) {
      blocks.back().text += line + "\n";
    }
    is_inside ^= is_fence;
    if (!line.empty()) before = line;
  }
  return blocks;
}

/// What a reader types, as a script.
std::string script_of(const std::string& guide) {
  std::string script = "set -e\n";
  for (const Block& block : blocks_of(guide)) {
    if (!block.file.empty() && block.language != "sh")
      script += "cat > " + block.file + " <<'EOF'\n" + block.text + "EOF\n";
    else if (block.language == "sh" && block.text.find("--target wait") == std::string::npos)
      script += block.text;
  }
  return script;
}

/// A home in which Tether is installed from this build, as the guide of own programs says.
class Guide : public testing::Test {
 protected:
  static void SetUpTestSuite() { home_ = std::make_unique<TempFolder>(); }
  static void TearDownTestSuite() { home_.reset(); }

  /// Runs the guide's commands in an empty folder. This build stands in for the one of the guide.
  static Output followed(const std::string& guide, const std::vector<Substitution>& changes) {
    std::string script = substituted(script_of(guide), changes);
    script = std::regex_replace(script, std::regex("scripts/(deps|build) [^\n]*"), "");
    script = std::regex_replace(script, std::regex("cmake --install build/release"),
                                TETHER_CMAKE " --install " TETHER_BINARY_DIR);
    const auto folder = *home_ / guide;
    std::filesystem::create_directory(folder);
    const std::string path = (*home_ / "tether/bin").string() + ":/usr/local/bin:/usr/bin:/bin";
    return run({{"bash", "-c", script},
                {{"HOME", home_->path()}, {"PATH", path}, {"CC", "gcc"}, {"CXX", "g++"}},
                folder},
               std::chrono::seconds(300));
  }

  static inline std::unique_ptr<TempFolder> home_;
};

TEST_F(Guide, OfAProgramAndOfAUavWorkAsWritten) {
  const Output program = followed("your-own-sut.md", {{"--trials 10", "--trials 1"}});
  EXPECT_EQ(program.code, 0) << program.out << program.err;
  const auto folder = *home_ / "your-own-sut.md/my_program/out";
  for (const char* flight : {"mine", "mine_slow"})
    EXPECT_EQ(read_result(folder / flight)["suts"][0]["outcome"], "faces the anchor") << flight;
  EXPECT_TRUE(std::filesystem::exists(folder / "mine/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "campaign/campaign.json"));

  const Output uav = followed("your-own-uav.md", {});
  EXPECT_EQ(uav.code, 0) << uav.out << uav.err;
  const auto result = read_result(*home_ / "your-own-uav.md/out/x_frame");
  EXPECT_EQ(result["outcome"], "goal_reached");
}

}  // namespace
}  // namespace tether::system_test
