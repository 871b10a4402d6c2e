#include "code_scanner.h"
#include "source_tree.h"

#include <array>
#include <cstdio>

#include <gtest/gtest.h>

namespace tether::layout {
namespace {

namespace fs = std::filesystem;

// Put together here, so that this file does not hold what it looks for.
const std::vector<std::string>& leftover_marks() {
  static const std::vector<std::string> kMarks = {
      std::string("TO") + "DO", std::string("FIX") + "ME", std::string("XX") + "X",
      std::string("HA") + "CK"};
  return kMarks;
}

TEST(Documents, NothingIsLeftForLater) {
  std::vector<std::string> found;
  for (const fs::path& file : text_files(TETHER_SOURCE_DIR)) {
    const std::string text = read_text(file);
    for (const std::string& mark : leftover_marks()) {
      for (const int line : lines_with_word(text, mark)) {
        found.push_back(fs::relative(file, TETHER_SOURCE_DIR).generic_string() + ":" +
                        std::to_string(line) + ": " + mark);
      }
    }
  }
  EXPECT_EQ(one_per_line(found), "");
}

/// What stands between each `open` and the next `close`.
std::vector<std::string> between(const std::string& text, const std::string& open, char close) {
  std::vector<std::string> found;
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    found.push_back(text.substr(begin, text.find(close, begin) - begin));
  }
  return found;
}

std::vector<std::string> link_targets(const std::string& markdown) {
  std::vector<std::string> targets = between(markdown, "](", ')');
  for (const std::string& image : between(markdown, "src=\"", '"')) targets.push_back(image);
  return targets;
}

bool is_external(const std::string& target) {
  return target.starts_with("http://") || target.starts_with("https://") ||
         target.starts_with("#") || target.starts_with("mailto:");
}

TEST(Documents, LinksLeadSomewhere) {
  std::vector<std::string> dead;
  for (const fs::path& file : text_files(TETHER_SOURCE_DIR)) {
    if (file.extension() != ".md") continue;
    for (const std::string& target : link_targets(read_text(file))) {
      const std::string path = target.substr(0, target.find('#'));
      if (is_external(target) || fs::exists(file.parent_path() / path)) continue;
      dead.push_back(fs::relative(file, TETHER_SOURCE_DIR).generic_string() + ": " + target);
    }
  }
  EXPECT_EQ(one_per_line(dead), "");
}

TEST(Documents, EachDecisionHasItsParts) {
  std::vector<std::string> wanting;
  const fs::path folder = fs::path(TETHER_SOURCE_DIR) / "docs/adr";
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md") continue;
    const std::string text = read_text(entry.path());
    for (const char* part :
         {"Status:", "## Context", "## Decision", "## Consequences", "## Alternatives"}) {
      if (text.find(part) == std::string::npos) wanting.push_back(name + ": no '" + part + "'");
    }
    const std::string index = read_text(folder / "README.md");
    if (index.find("(" + name + ")") == std::string::npos)
      wanting.push_back(name + ": not in docs/adr/README.md");
  }
  EXPECT_EQ(one_per_line(wanting), "");
}

std::string printed_by(const std::string& command) {
  FILE* output = ::popen(command.c_str(), "r");
  if (output == nullptr) return "";
  std::string text;
  std::array<char, 4096> block{};
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), output))
    text.append(block.data(), size);
  ::pclose(output);
  return text;
}

TEST(Documents, EachScriptsHelpIsItsCommentAlone) {
  int scripts = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(TETHER_SOURCE_DIR) / "scripts")) {
    // What has no help would do its work.
    const std::string text = entry.is_regular_file() ? read_text(entry.path()) : "";
    if (text.find("-h | --help) usage; exit 0 ;;") == std::string::npos) continue;
    const std::string name = entry.path().filename().string();
    const std::string help = printed_by("'" + entry.path().string() + "' --help 2>&1");
    EXPECT_NE(help.find("\nusage: scripts/" + name), std::string::npos) << help;
    EXPECT_EQ(help.find("shellcheck"), std::string::npos) << help;
    ++scripts;
  }
  EXPECT_GT(scripts, 5);
}

}  // namespace
}  // namespace tether::layout
