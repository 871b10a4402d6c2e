#include "support/files.h"
#include "support/process.h"

#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

/// docs/man names every command and option that --help names.
namespace tether::system_test {
namespace {

struct Help {
  std::set<std::string> options;   ///< without the dashes
  std::set<std::string> commands;  ///< in alphabetical order
};

/// Options and subcommands of one page of --help; what its examples mention is not meant.
Help parse_help(const std::string& text) {
  static const std::regex kOption("^  (-[A-Za-z],)?--([a-z][a-z0-9-]*)");
  static const std::regex kCommand("^  ([a-z][a-z0-9_-]*)( .*)?$");
  Help help;
  std::string section;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() != ' ') section = line;
    std::smatch match;
    if (section == "Options:" && std::regex_search(line, match, kOption))
      help.options.insert(match[2]);
    if (section == "Subcommands:" && std::regex_search(line, match, kCommand))
      help.commands.insert(match[1]);
  }
  return help;
}

/// `words` is the program and its subcommands so far.
void collect(std::vector<std::string> words, Help& all) {
  words.push_back("--help");
  const Output output = run({words, {}, {}});
  EXPECT_EQ(output.code, 0) << output.err;
  words.pop_back();
  Help here = parse_help(output.out);
  EXPECT_TRUE(here.options.contains("help")) << output.out;
  all.options.merge(here.options);
  for (const auto& command : here.commands) {
    all.commands.insert(command);
    words.push_back(command);
    collect(words, all);
    words.pop_back();
  }
}

std::filesystem::path page_of(const std::string& name) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / "docs/man" / name;
}

/// Whether the page has the macro with that argument as a word of its own.
bool mentions(const std::string& page, const std::string& macro, const std::string& argument) {
  return std::regex_search(page, std::regex(macro + " " + argument + "(?![A-Za-z0-9_-])"));
}

/// What --help has and the page has not.
std::string missing_from(const std::string& page, const Help& help) {
  std::string missing;
  for (const auto& option : help.options)
    if (!mentions(page, "Fl", "-" + option)) missing += " --" + option;
  for (const auto& command : help.commands)
    if (!mentions(page, "Cm", command)) missing += " " + command;  // as in SYNOPSIS
  return missing;
}

class Program : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Program, HasEveryCommandAndOptionInItsPage) {
  Help help;
  collect({GetParam()}, help);
  EXPECT_GT(help.options.size(), 1u);
  const std::string file = GetParam().filename().string() + ".1";
  EXPECT_EQ(missing_from(read_text(page_of(file)), help), "") << "not in docs/man/" << file;
}

std::vector<std::filesystem::path> programs() {
  std::vector<std::filesystem::path> list;
  std::istringstream paths(PROGRAMS_WITH_A_PAGE);
  for (std::string path; std::getline(paths, path, ':');) list.emplace_back(path);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Programs, Program, testing::ValuesIn(programs()), [](const auto& program) {
  return std::regex_replace(program.param.filename().string(), std::regex("-"), "_");
});

TEST(ManualPages, AnOmissionIsFound) {
  const Help help = parse_help(
      "Usage: x\n\nOptions:\n  -h,--help   Print\n  --out FILE  Where\n\n"
      "Subcommands:\n  run         Runs\n\nExamples:\n  x --other run\n");
  EXPECT_EQ(help.options, (std::set<std::string>{"help", "out"}));
  EXPECT_EQ(help.commands, (std::set<std::string>{"run"}));
  EXPECT_EQ(missing_from(".Fl -help .Fl -out-of-date .Cm runs", help), " --out run");
  EXPECT_EQ(missing_from(".Fl -help .It Fl -out Ar file .Cm run", help), "");
}

TEST(ManualPages, AreWellFormed) {
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(page_of(""))) {
    const Output output = run({{"mandoc", "-Tlint", "-Wwarning", entry.path()}, {}, {}});
    EXPECT_EQ(output.code, 0) << output.out << output.err;
    ++pages;
  }
  EXPECT_GE(pages, 3);
}

/// The page of the library names every status.
TEST(ManualPages, TellEveryStatus) {
  const std::string header = read_text(std::filesystem::path(TETHER_SOURCE_DIR) /
                                       "target/client/c_api/include/tether/client.h");
  const std::string page = read_text(page_of("tether-client.3"));
  const auto end = header.find("tether_status_name");
  const std::regex status("(TETHER_[A-Z_]+) = [0-9]+");
  int count = 0;
  for (std::sregex_iterator it(header.begin(), header.begin() + static_cast<long>(end), status),
       last;
       it != last; ++it, ++count)
    EXPECT_TRUE(mentions(page, "Dv", (*it)[1])) << (*it)[1];
  EXPECT_EQ(count, 10);
}

}  // namespace
}  // namespace tether::system_test
