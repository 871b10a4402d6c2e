#include "files/lookups.h"

#include <chrono>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::sim {
namespace {

namespace fs = std::filesystem;

class LookupsTest : public ::testing::Test {
 protected:
  /// Whether a change after questions shows in their answers.
  template <class Ask, class Change>
  static bool shows(Ask ask, Change change) {
    const Lookups lookups(Duration(0));
    ask();
    EXPECT_TRUE(are_current(lookups.answers()));
    change();
    return !are_current(lookups.answers());
  }

  ScratchFolder folder_;
};

TEST_F(LookupsTest, ShowThatAFileChangedAppearedOrWent) {
  const fs::path file = folder_.path("a");
  const auto write = [&](const char* text) { folder_.write("a", text); };
  EXPECT_TRUE(shows([&] { EXPECT_FALSE(is_there(file)); }, [&] { write("1"); }));
  EXPECT_TRUE(shows([&] { EXPECT_TRUE(is_file(file)); }, [&] { write("12"); }));
  EXPECT_TRUE(shows([&] { EXPECT_EQ(read_file(file, 9), "12"); }, [&] { write("123"); }));
  EXPECT_TRUE(shows([&] { note_file(file); }, [&] { fs::remove(file); }));
}

TEST_F(LookupsTest, ShowAnotherFileOfTheSameSizeAndTime) {
  const fs::path file = folder_.write("a", "1");
  folder_.write("b", "2");
  fs::last_write_time(folder_.path("b"), fs::last_write_time(file));
  EXPECT_TRUE(shows([&] { is_file(file); }, [&] { fs::rename(folder_.path("b"), file); }));
}

TEST_F(LookupsTest, ShowNewEntriesOnlyOfAFolderWhoseEntriesMatter) {
  const fs::path folder = folder_.write("f/a", "").parent_path();
  const auto list = [&] { EXPECT_EQ(entries_of(folder).size(), 1U); };
  EXPECT_FALSE(shows([&] { EXPECT_TRUE(is_folder(folder)); }, [&] { folder_.write("f/b", ""); }));
  fs::remove(folder / "b");
  EXPECT_TRUE(shows(list, [&] { folder_.write("f/b", ""); }));
  EXPECT_TRUE(shows([&] { is_folder(folder); }, [&] { fs::remove_all(folder); }));
  EXPECT_TRUE(shows([&] { EXPECT_TRUE(entries_of(folder).empty()); },
                    [&] { fs::create_directory(folder); }));
}

TEST_F(LookupsTest, AreCertainOnlyOfWhatIsOld) {
  const fs::path file = folder_.write("a", "1");
  const Lookups of_new(std::chrono::hours(1));
  is_file(file);
  EXPECT_FALSE(of_new.are_certain());
  const Lookups of_old(std::chrono::seconds(2));
  is_file("/bin/sh");
  is_file(folder_.path("missing"));
  EXPECT_TRUE(of_old.are_certain());
  EXPECT_EQ(of_old.answers().size(), 2U);
  EXPECT_EQ(of_new.answers().size(), 1U);
}

}  // namespace
}  // namespace tether::sim
