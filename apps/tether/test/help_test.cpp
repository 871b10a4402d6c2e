#include "shared/help.h"

#include "shared/within.h"

#include <gtest/gtest.h>

#include <tether/base/text.h>

namespace tether::app {
namespace {

class Help : public testing::Test {
 protected:
  Help() {
    program_.add_option("--jobs", jobs_, "Parallel trials")
        ->check(within(1.0, 8.0))
        ->capture_default_str();
    program_.add_option("--limit", limit_, "The most")
        ->check(within(0.0, 1e6))
        ->type_name("PERCENT");
    program_
        .add_option("--format", text_,
                    "The form of what is written to the standard output, or to a file")
        ->check(CLI::IsMember({"text", "html"}));
    program_.add_option("--yaw-rate-deg-s", limit_, "Rate");
    program_.add_option("--clockwise", flag_, "Direction")->capture_default_str();
    program_.add_flag("--force", flag_, "Replace");
  }
  std::string at(std::size_t columns) {
    program_.formatter(help_format(columns));
    return program_.help();
  }
  CLI::App program_{
      "Does something that needs more words than fit in one line of a narrow terminal.", "demo"};
  unsigned jobs_ = 2;
  double limit_ = 0.0;
  std::string text_;
  bool flag_ = false;
};

TEST_F(Help, HasTheRangeAndTheDefaultOfANumberAndTheChoices) {
  const std::string help = at(100);
  for (const char* line :
       {"\n  --jobs NUMBER           Parallel trials. A whole number from 1 to 8 [2]\n",
        "\n  --limit PERCENT         The most. A number from 0 to 1000000\n",
        "\n  --format text|html      The form of what", "\n  --yaw-rate-deg-s DEG/S  Rate\n",
        "\n  --clockwise true|false  Direction [false]\n", "\n  --force                 Replace\n"})
    EXPECT_NE(help.find(line), std::string::npos) << line << help;
}

TEST_F(Help, FitsTheTerminal) {
  for (const std::size_t columns : {40u, 60u, 80u, 120u}) {
    std::istringstream lines(at(columns));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(columns_of(line), columns) << line;
  }
}

}  // namespace
}  // namespace tether::app
