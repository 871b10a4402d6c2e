#include "code_scanner.h"
#include "source_tree.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

/// Files have at most 500 lines (clang-tidy checks the length of functions), and each source has a
/// test.
namespace tether::layout {
namespace {

constexpr int kMaxFileLines = 500;

TEST(Sizes, FilesStayShort) {
  std::vector<std::string> long_files;
  for (const SourceFile& file : read_sources(TETHER_SOURCE_DIR)) {
    const int lines = count_lines(file.text);
    if (lines > kMaxFileLines)
      long_files.push_back(file.path + ": " + std::to_string(lines) + " lines");
  }
  EXPECT_EQ(one_per_line(long_files), "");
}

// Each source has tests of its own: a test named after it (src/x.cpp → test/x[_…]_test.cpp), or one
// that includes its header. The few that are tested through others are named, with the reason, in
// untested.txt.

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

std::set<std::string> read_exceptions() {
  std::istringstream lines(read_text(std::filesystem::path(TETHER_TEST_DIR) / "untested.txt"));
  std::set<std::string> exceptions;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t space = line.find_first_of(" \t");
    EXPECT_NE(space, std::string::npos) << "untested.txt: no reason given for " << line;
    exceptions.insert(line.substr(0, space));
  }
  return exceptions;
}

/// Names of what is tested: libraries' sources by their test's name and by the headers that tests
/// include, as "library/stem".
std::set<std::string> tested_names(const std::vector<SourceFile>& files) {
  std::set<std::string> names;
  for (const SourceFile& file : files) {
    if (file.role != Role::kTest) continue;
    for (const Include& include : includes(file.text))
      names.insert(file.library + "/" + stem(include.path));
    // "x_y_test" is a test of x as well as of x_y.
    std::string name = stem(file.path);
    for (std::size_t end = name.rfind('_'); end != std::string::npos; end = name.rfind('_')) {
      name.resize(end);
      names.insert(file.library + "/" + name);
    }
  }
  return names;
}

TEST(Mirror, EverySourceHasItsTests) {
  const std::vector<SourceFile> files = read_sources(TETHER_SOURCE_DIR);
  const std::set<std::string> tested = tested_names(files);
  std::set<std::string> exceptions = read_exceptions();
  std::vector<std::string> untested;
  for (const SourceFile& file : files) {
    if (file.role != Role::kSource || file.is_header()) continue;
    if (tested.contains(file.library + "/" + stem(file.path))) continue;
    if (exceptions.erase(file.path) == 0) untested.push_back(file.path);
  }
  EXPECT_EQ(one_per_line(untested), "")
      << "add a test, or a line with the reason to tests/layout/untested.txt";
  const std::vector<std::string> unused(exceptions.begin(), exceptions.end());
  EXPECT_EQ(one_per_line(unused), "") << "untested.txt names files that have tests or are gone";
}

}  // namespace
}  // namespace tether::layout
