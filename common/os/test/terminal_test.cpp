#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>

#include <tether/os/file_descriptor.h>
#include <tether/os/terminal.h>

namespace tether::os {
namespace {

TEST(Terminal, TellsItsColumnsAsTheyAre) {
  int master = -1, slave = -1;
  ASSERT_EQ(openpty(&master, &slave, nullptr, nullptr, nullptr), 0);
  const FileDescriptor outer(master), inner(slave);
  for (const auto& [set, told] : {std::pair{60, 60}, {200, 200}, {0, 80}}) {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(set);
    ASSERT_EQ(ioctl(master, TIOCSWINSZ, &size), 0);
    EXPECT_EQ(terminal_columns(slave), told);
  }
  EXPECT_EQ(terminal_columns(make_pipe().write_end.get()), 0);
}

TEST(Terminal, CutsTextBetweenCharactersByTheirWidth) {
  struct Case {
    std::string text;
    int columns;
    std::string cut;
  };
  for (const Case& c : {Case{"12345", 6, "12345"},
                        {"12345", 5, "123…"},
                        {"äöüßé", 6, "äöüßé"},
                        {"äöüßé", 4, "äö…"},
                        {"水平飛行", 9, "水平飛行"},
                        {"水平飛行", 7, "水平…"},
                        {"e\u0301e\u0301e", 4, "e\u0301e\u0301e"},
                        {"\xff\xfe\xfd", 4, "\xff\xfe\xfd"},
                        {"1", 2, "1"},
                        {"12", 2, "…"},
                        {"12", 1, ""},
                        {"", 1, ""}})
    EXPECT_EQ(cut_to_columns(c.text, c.columns), c.cut) << c.text << " in " << c.columns;
}

TEST(Terminal, ShowsTheFirstFieldsThatFit) {
  const std::vector<std::string> fields = {"ST 1 s", "", "ET 2 s", "8 frames"};
  for (const auto& [columns, line] : {std::pair{25, "ST 1 s  ET 2 s  8 frames"},
                                      {24, "ST 1 s  ET 2 s"},
                                      {15, "ST 1 s  ET 2 s"},
                                      {14, "ST 1 s"},
                                      {7, "ST 1 s"},
                                      {6, "ST 1…"}})
    EXPECT_EQ(fields_in_columns(fields, columns), line) << columns;
}

// A test's output is no terminal.
TEST(Terminal, TextsAreAsWideAsColumnsSaysOrAHundred) {
  for (const auto& [given, columns] :
       {std::pair("60", 60u), std::pair("19", 100u), std::pair("80x", 100u), std::pair("", 100u)}) {
    ::setenv("COLUMNS", given, 1);
    EXPECT_EQ(text_columns(-1), columns) << given;
  }
  ::unsetenv("COLUMNS");
  EXPECT_FALSE(shows_colours(-1));
}

}  // namespace
}  // namespace tether::os
