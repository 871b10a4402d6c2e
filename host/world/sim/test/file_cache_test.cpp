#include <cstdlib>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/os/text_file.h>
#include <tether/sim/file_cache.h>

namespace tether::sim {
namespace {

namespace fs = std::filesystem;

/// Sets a variable of the environment for a while; none: removes it.
class Variable {
 public:
  Variable(const char* name, const std::optional<std::string>& value) : name_(name) {
    if (const char* now = std::getenv(name)) before_ = now;
    set(value);
  }
  ~Variable() { set(before_); }

 private:
  void set(const std::optional<std::string>& value) {
    value ? ::setenv(name_, value->c_str(), 1) : ::unsetenv(name_);
  }
  const char* name_;
  std::optional<std::string> before_;
};

class Cache : public ::testing::Test {
 protected:
  std::string found(const std::string& key) const {
    const auto content = cache_.find(key);
    return content ? std::string(content->front()) : "none";
  }
  fs::path only_file() const { return fs::directory_iterator(cache_.folder())->path(); }

  ScratchFolder folder_;
  FileCache cache_{folder_.path("cache")};
};

TEST_F(Cache, FindsWhatItKeeps) {
  EXPECT_EQ(found("a"), "none");
  cache_.keep("a", "one");
  cache_.keep("b", "two");
  cache_.keep("a", "three");
  EXPECT_EQ(found("a"), "three");
  EXPECT_EQ(found("b"), "two");
  EXPECT_EQ(cache_.size().entries, 2U);
}

TEST_F(Cache, KeepsPartsAtPlacesForVectors) {
  const std::vector<std::string_view> parts{"one", "", "two"};
  cache_.keep(std::string(77, 'k'), parts, 1);
  const auto content = cache_.find(std::string(77, 'k'));
  ASSERT_TRUE(content);
  EXPECT_EQ(*content, parts);
  for (const std::string_view part : *content)
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(part.data()) % 64, 0U);
}

TEST_F(Cache, IgnoresADamagedFileAndWritesItAgain) {
  cache_.keep("key", "content");
  const std::string good = os::read_whole(only_file());
  const auto is_ignored = [&](const std::string& bytes) {
    folder_.write("cache/" + only_file().filename().string(), bytes);
    return cache_.find("key") == nullptr;
  };
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_TRUE(is_ignored(good.substr(0, size))) << size;
  EXPECT_TRUE(is_ignored(good + "x"));
  const std::size_t key_ends = good.find("key") + 3, content = good.find("content");
  for (std::size_t at = 0; at < content + 7; ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    EXPECT_NE(is_ignored(bad), at >= key_ends && at < content) << at;
  }
  cache_.keep("key", "content");
  EXPECT_EQ(found("key"), "content");
}

TEST_F(Cache, ComparesOnlyCheckedParts) {
  const std::vector<std::string_view> parts{"checked", "free"};
  cache_.keep("key", parts, 1);
  std::string bytes = os::read_whole(only_file());
  bytes[bytes.find("free")] = 'F';
  folder_.write("cache/" + only_file().filename().string(), bytes);
  EXPECT_EQ(cache_.find("key")->back(), "Free");
}

TEST_F(Cache, RemovesTheOldestUsedBeyondItsLimit) {
  const FileCache small(folder_.path("cache"), 1500);
  const auto age = [&](const fs::path& file, int hours) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  const std::string content(300, 'x');
  small.keep("a", content);
  age(only_file(), 3);
  folder_.write("cache/left.part", content);
  age(folder_.path("cache/left.part"), 5);
  small.keep("b", content);
  for (const auto& entry : fs::directory_iterator(small.folder()))
    if (entry.path().extension() == ".entry") age(entry.path(), 2);
  EXPECT_NE(small.find("a"), nullptr);  // used
  small.keep("c", content);
  EXPECT_LE(small.size().bytes, 1500U);
  EXPECT_NE(small.find("a"), nullptr);
  EXPECT_EQ(small.find("b"), nullptr);
  EXPECT_NE(small.find("c"), nullptr);
  small.keep("d", std::string(1501, 'x'));  // never
  EXPECT_EQ(small.find("d"), nullptr);
  EXPECT_EQ(small.size().entries, 2U);
}

TEST_F(Cache, AnEntryOutlivesItsFile) {
  cache_.keep("a", "one");
  const auto content = cache_.find("a");
  cache_.clear();
  EXPECT_EQ(cache_.size().entries, 0U);
  EXPECT_EQ(cache_.find("a"), nullptr);
  EXPECT_EQ(content->front(), "one");
}

TEST_F(Cache, ClearsOnlyItsOwnFiles) {
  cache_.keep("a", "one");
  folder_.write("cache/notes.txt", "");
  cache_.clear();
  EXPECT_TRUE(fs::exists(folder_.path("cache/notes.txt")));
}

TEST_F(Cache, ReadersMeetWholeEntriesOfConcurrentWriters) {
  constexpr int kProcesses = 4, kTimes = 40;
  const auto write_and_read = [&](char own) {
    for (int i = 0; i < kTimes; ++i) {
      cache_.keep("key", std::string(20'000, own));
      const auto content = cache_.find("key");
      if (content == nullptr || content->front().size() != 20'000 ||
          content->front().find_first_not_of(content->front()[0]) != std::string_view::npos)
        return 1;
    }
    return 0;
  };
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(write_and_read(static_cast<char>('a' + i)));
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(cache_.size().entries, 1U);
}

TEST_F(Cache, DoesWithoutAFolder) {
  folder_.write("file", "");
  const FileCache nowhere(folder_.path("file/cache"));
  nowhere.keep("a", "one");
  EXPECT_EQ(nowhere.find("a"), nullptr);
  EXPECT_EQ(nowhere.size().entries, 0U);
  EXPECT_NO_THROW(nowhere.clear());
  EXPECT_THROW(nowhere.require_writable(), Error);
  EXPECT_NO_THROW(cache_.require_writable());
  EXPECT_EQ(cache_.size().entries, 0U);
}

TEST(FileState, ChangesWithAFileAndIsOldOnceItHasAged) {
  const ScratchFolder folder;
  const fs::path file = folder.path("a");
  const FileState missing = state_of(file);
  EXPECT_EQ(missing, FileState{});
  folder.write("a", "1");
  const FileState first = state_of(file);
  EXPECT_NE(first, missing);
  EXPECT_EQ(first, state_of(file));
  EXPECT_FALSE(is_older(first, std::chrono::hours(1)));
  EXPECT_TRUE(is_older(first, Duration(0)));
  const FileState with_one = state_of(folder.path(), true), folder_itself = state_of(folder.path());
  folder.write("b", "");
  EXPECT_NE(state_of(folder.path(), true), with_one);
  EXPECT_EQ(state_of(folder.path()), folder_itself);
}

TEST(CacheOfUser, IsWhereTheEnvironmentSays) {
  const Variable own("TETHER_CACHE", std::nullopt);
  const Variable xdg("XDG_CACHE_HOME", "/x");
  const Variable home("HOME", "/h");
  const auto folder = [] {
    const auto cache = FileCache::of_user();
    return cache ? cache->folder().string() : "none";
  };
  EXPECT_EQ(folder(), "/x/tether");
  const Variable relative("XDG_CACHE_HOME", "x");
  EXPECT_EQ(folder(), "/h/.cache/tether");
  const Variable chosen("TETHER_CACHE", "/own");
  EXPECT_EQ(folder(), "/own");
  const Variable off("TETHER_CACHE", "off");
  EXPECT_EQ(folder(), "none");
}

TEST(CacheOfUser, IsNotWithoutAHome) {
  const Variable own("TETHER_CACHE", std::nullopt);
  const Variable xdg("XDG_CACHE_HOME", std::nullopt);
  const Variable home("HOME", std::nullopt);
  EXPECT_FALSE(FileCache::of_user());
}

}  // namespace
}  // namespace tether::sim
