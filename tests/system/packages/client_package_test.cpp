#include "support/files.h"
#include "support/installed.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The client library as it is installed: what it shows, what it needs, and that it is found.
namespace tether::system_test {
namespace {

using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kVersion = TETHER_VERSION_NUMBER;

class ClientPackage : public testing::Test {
 protected:
  ClientPackage() { install_client(prefix_); }

  std::filesystem::path library() const {
    return folder_of(prefix_, "libtether-client.so.1") / "libtether-client.so.1";
  }
  std::string pkg_config(const std::filesystem::path& prefix, const std::string& question) const {
    const auto folder = folder_of(prefix, "tether-client.pc");
    return output_of({"pkg-config", question, "tether-client"}, {{"PKG_CONFIG_PATH", folder}});
  }

  TempFolder folder_;
  const std::filesystem::path prefix_ = folder_ / "installed";
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  return lines;
}

/// Names as `nm` prints them in the first column; the version's own, which is absolute, left out.
std::set<std::string> symbols_of(const std::filesystem::path& library) {
  std::set<std::string> symbols;
  for (const auto& line :
       lines_of(output_of({"nm", "-D", "--defined-only", "--format=posix", library}))) {
    std::istringstream words(line);
    std::string name, type;
    words >> name >> type;
    if (type != "A") symbols.insert(name);
  }
  return symbols;
}

TEST_F(ClientPackage, ShowsTheCommittedSymbolsAndNoOther) {
  const auto lines = lines_of(
      read_text(std::filesystem::path(TETHER_SOURCE_DIR) / "target/client/c_api/abi/symbols.txt"));
  const std::set<std::string> committed(lines.begin(), lines.end());
  EXPECT_GT(committed.size(), 40u);
  EXPECT_EQ(symbols_of(library()), committed) << "a name that is gone breaks programs; a new one "
                                                 "belongs into abi/symbols.txt and a node of "
                                                 "its own in abi/exports.map";
  EXPECT_THAT(committed, Each(StartsWith("tether_")));
}

TEST_F(ClientPackage, NeedsTheStandardLibrariesOnly) {
  std::vector<std::string> needed;
  for (const auto& line : lines_of(output_of({"readelf", "--dynamic", "--wide", library()}))) {
    const auto open = line.find('[');
    if (line.find("(NEEDED)") == std::string::npos) continue;
    needed.push_back(line.substr(open + 1, line.find(']') - open - 1));
  }
  EXPECT_FALSE(needed.empty());
  EXPECT_THAT(needed, Each(AnyOf("libc.so.6", "libm.so.6", "libpthread.so.0", "libstdc++.so.6",
                                 "libgcc_s.so.1", StartsWith("ld-linux"))));
}

TEST_F(ClientPackage, TellsItsNameToTheLoader) {
  EXPECT_THAT(output_of({"readelf", "--dynamic", library()}),
              HasSubstr("soname: [libtether-client.so.1]"));
  EXPECT_TRUE(std::filesystem::is_symlink(library().parent_path() / "libtether-client.so"));
}

TEST_F(ClientPackage, IsRightWhereverItIsMoved) {
  const auto moved = folder_ / "moved here";
  std::filesystem::rename(prefix_, moved);
  EXPECT_EQ(pkg_config(moved, "--modversion"), kVersion + "\n");
  for (const auto& [variable, file] :
       {std::pair{"libdir", "libtether-client.so"}, std::pair{"includedir", "tether/client.hpp"}}) {
    std::string path = pkg_config(moved, std::string("--variable=") + variable);
    path.erase(std::remove(path.begin(), path.end(), '\\'), path.end());  // before the blank
    EXPECT_TRUE(
        std::filesystem::exists(std::filesystem::path(path.substr(0, path.size() - 1)) / file))
        << path;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(moved)) {
    const auto extension = entry.path().extension();
    if (extension != ".cmake" && extension != ".pc") continue;
    EXPECT_THAT(read_text(entry.path()), Not(HasSubstr(prefix_.string()))) << entry.path();
  }
}

/// A program that needs a later one is not configured.
TEST_F(ClientPackage, CMakeChecksTheVersion) {
  const auto project = folder_ / "project";
  std::filesystem::create_directory(project);
  const auto configure = [&](const std::string& version) {
    write_text(
        project / "CMakeLists.txt",
        "cmake_minimum_required(VERSION 3.16)\nproject(p LANGUAGES NONE)\n"
        "find_package(tether-client " +
            version +
            " REQUIRED)\n"
            "if(NOT TARGET tether::client)\n  message(FATAL_ERROR \"no target\")\nendif()\n");
    return run({{TETHER_CMAKE, "-S", project, "-B", project / ("build-" + version),
                 "-DCMAKE_PREFIX_PATH=" + prefix_.string()}})
        .code;
  };
  EXPECT_EQ(configure(kVersion), 0);
  EXPECT_NE(configure("99.0"), 0);
}

TEST(DocPackage, HasTheSite) {
  if (!std::filesystem::exists(std::filesystem::path(TETHER_SOURCE_DIR) / "build/docs/html"))
    GTEST_SKIP() << "the site is missing; scripts/docs builds it";
  const TempFolder folder;
  output_of({TETHER_CMAKE, "--install", TETHER_BINARY_DIR, "--prefix", folder / "installed",
             "--component", "doc"});
  const auto site = folder / "installed/share/doc/tether-doc/html";
  for (const char* page : {"index.html", "guide-board.html", "adr.html", "group__c__reading.html",
                           "classtether_1_1api_1_1Vehicle.html", "tracked_roi.png"})
    EXPECT_TRUE(std::filesystem::exists(site / page)) << page;
}

}  // namespace
}  // namespace tether::system_test
