#include "support/files.h"
#include "support/process.h"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::system_test {
namespace {

using testing::HasSubstr;

const std::filesystem::path kClientPage =
    std::filesystem::path(TETHER_SOURCE_DIR) / "docs/man/tether-client.3";

class ManualPage : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ManualPage, IsWellFormed) {
  const Output output = run({{"mandoc", "-Tlint", "-Wwarning", GetParam()}, {}, {}});
  EXPECT_EQ(output.code, 0) << output.out << output.err;
}

TEST_P(ManualPage, HasAllSections) {
  const std::string page = read_text(GetParam());
  for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "SEE ALSO"})
    EXPECT_THAT(page, HasSubstr(std::string("\n.Sh ") + section + "\n"));
  if (GetParam() == kClientPage) return;
  for (const char* section : {"OPTIONS", "ENVIRONMENT", "EXIT STATUS", "EXAMPLES"})
    EXPECT_THAT(page, HasSubstr(std::string("\n.Sh ") + section + "\n"));
  EXPECT_THAT(page, HasSubstr("\n.It Fl h , Fl -help\n"));
  EXPECT_EQ(page.find("\n@"), std::string::npos) << "not filled in by the program";
}

// What the program fills in: apps/tether/test/manual_test.cpp.
INSTANTIATE_TEST_SUITE_P(
    All, ManualPage,
    testing::Values(std::filesystem::path(TETHER_BINARY_DIR) / "man/tether.1",
                    std::filesystem::path(TETHER_BINARY_DIR) / "man/tether-sut.1",
                    std::filesystem::path(TETHER_BINARY_DIR) / "man/tether-exec.1", kClientPage),
    [](const auto& page) {
      return std::regex_replace(page.param.stem().string(), std::regex("-"), "_");
    });

TEST(ClientPage, NamesEachStatus) {
  const std::string header = read_text(std::filesystem::path(TETHER_SOURCE_DIR) /
                                       "target/client/c_api/include/tether/client.h");
  const std::string page = read_text(kClientPage);
  const auto end = header.find("tether_status_name");
  const std::regex status("(TETHER_[A-Z_]+) = [0-9]+");
  int count = 0;
  for (std::sregex_iterator it(header.begin(), header.begin() + static_cast<long>(end), status),
       last;
       it != last; ++it, ++count)
    EXPECT_TRUE(std::regex_search(page, std::regex("Dv " + (*it)[1].str() + "(?![A-Z_])")))
        << (*it)[1];
  EXPECT_EQ(count, 10);
}

}  // namespace
}  // namespace tether::system_test
