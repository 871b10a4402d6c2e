#include "sample_timing.h"

#include <fstream>
#include <utility>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::timing {
namespace {

class TimingFile : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(file_) << text; }

  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.path("board.timing");
};

TEST_F(TimingFile, KeepsEverything) {
  Timing timing = sample_timing();
  timing.counted_ns = {{"detect", 1234.5678901234567}, {"decide", 0.0}};
  timing.doubts = {{Doubt::Kind::kUnseenWait, "uav1", 0.4}, {Doubt::Kind::kBusyMachine, "", 0.1}};
  add(timing, Doubt{Doubt::Kind::kBusyMachine, "", 0.3});
  EXPECT_EQ(timing.doubts.back().amount, 0.3);
  write_timing(file_, timing);
  EXPECT_TRUE(is_timing_file(file_));
  EXPECT_EQ(read_timing(file_), timing);
}

// A file that was cut anywhere is refused, and never read as a shorter one.
TEST_F(TimingFile, RefusesEachTruncatedFile) {
  write_timing(file_, sample_timing(1, 2));
  const std::string whole = os::read_file(file_);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write(whole.substr(0, size));
    bad_file_error([&] { read_timing(file_); });
  }
}

TEST_F(TimingFile, NamesTheLineOfAFault) {
  write_timing(file_, sample_timing(1, 2));
  const std::string whole = os::read_file(file_);
  const std::tuple<const char*, const char*, int> faults[] = {
      {"tether-timing\t2", "tether-timing\t3", 1},
      {"tether-timing\t2", "[scenario]", 1},
      {"scenario", "world", 2},
      {"run\tuav1\t1", "run\tuav1\t-1", 11},
      {"run\tuav1\t1", "fly\tuav1\t1", 11},
      {"call\tcamera\t", "call\tcamera\tlost\t", 12},
      {"call\tcamera\tstart to camera\t", "call\tcamera\tstart to camera\t-", 12},
      {"\tdetect\t", "\tcamera to command\t", 13},
      {"end\t4", "end\t5", 16},
      {"end\t4\n", "end\t4\nmore\n", 16},
      {"build\tuav1\targument 1", "counted\tdetect\t-1\nbuild\tuav1\targument 1", 9},
      {"run\tuav1\t1", "build\tuav1\nrun\tuav1\t1", 11},
      {"run\tuav1\t1", "doubt\tboredom\tuav1\t1\nrun\tuav1\t1", 11},
      {"run\tuav1\t1", "doubt\tunseen_wait\tuav1\tinf\nrun\tuav1\t1", 11}};
  for (const auto& [found, planted, line] : faults) {
    std::string text = whole;
    text.replace(text.find(found), std::string_view(found).size(), planted);
    write(text);
    const Error error = bad_file_error([&] { read_timing(file_); });
    EXPECT_EQ(error.where(), (FileLocation{file_.string(), line})) << planted;
  }
}

// Its times are still good for mode = "resampled".
TEST_F(TimingFile, ReadsSchemaOneWhichHasNoBuilds) {
  Timing timing = sample_timing();
  timing.builds.clear();
  timing.condition.clear();
  write_timing(file_, timing);
  std::string text = os::read_file(file_);
  text.replace(text.find("\t2\n"), 3, "\t1\n");
  write(text.erase(text.find("condition\t\n"), 11));
  EXPECT_EQ(read_timing(file_), timing);
}

}  // namespace
}  // namespace tether::timing
