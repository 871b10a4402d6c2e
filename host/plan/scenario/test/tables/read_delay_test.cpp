#include "tables/read_delay.h"

#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;

class DelaySamples : public testing::Test {
 protected:
  void expect_refused(int line, const std::string& text) const {
    const auto file = scratch_.write("d.txt", text);
    expect_refusal(line, "", [&] { (void)read_delay_samples(file, 1e-3); });
  }
  ScratchFolder scratch_;
};

TEST_F(DelaySamples, SkipsBlankLinesAndComments) {
  const auto file = scratch_.write("d.txt", "# measured 2024\r\n\n 0.0374 \r\n  # more\n0\n1e-3");
  EXPECT_THAT(read_delay_samples(file, 1.0),
              ElementsAre(Duration(37'400'000), Duration(0), Duration(1'000'000)));
}

TEST_F(DelaySamples, RefusesWhatIsNoDelayAtItsLine) {
  expect_refused(3, "1\n2\nthree\n");
  expect_refused(2, "1\n2 3\n");
  for (const std::string text : {"-0.5\n", "nan\n", "1e9\n", "0x10\n"}) expect_refused(1, text);
  for (const std::string text : {"", "# nothing\n\n", "\xEF\xBB\xBF"}) expect_refused(0, text);
}

TEST_F(DelaySamples, MayBeginWithAByteOrderMark) {
  const auto file = scratch_.write("d.txt", "\xEF\xBB\xBF# of Windows\r\n2\r\n");
  EXPECT_THAT(read_delay_samples(file, 1e-3), ElementsAre(Duration(2'000'000)));
  expect_refused(2, "1\n\xEF\xBB\xBF\x32\n");
}

TEST_F(DelaySamples, ShowsTheBeginningOfTheLineWithEscapedBytes) {
  const auto found = [&](const std::string& text) {
    const auto file = scratch_.write("d.txt", text);
    const std::string what = bad_file_error([&] { (void)read_delay_samples(file, 1e-3); }).what();
    return what.substr(what.find('"'));
  };
  EXPECT_EQ(found(std::string("1\0\r2\x1B[31m\t\xE9\x7F\n", 14)),
            "\"1\\x00\\x0D2\\x1B[31m\\x09\\xE9\\x7F\"");
  EXPECT_EQ(found(std::string(41, 'a')), '"' + std::string(40, 'a') + "…\"");
  EXPECT_EQ(found(std::string(40, 'a')), '"' + std::string(40, 'a') + "\"");
}

class InlineSamples : public testing::Test {
 protected:
  /// The delay of a sensor with that text.
  uav::Delay read(const std::string& text) {
    const auto file = scratch_.write("p.toml", "[camera]\ndelay = " + text + "\n");
    const toml::Document document = toml::Document::load(file);
    return read_delay(document.root().table("camera"), "delay", files_);
  }
  ScratchFolder scratch_;
  std::vector<std::filesystem::path> files_;
};

TEST_F(InlineSamples, AreReadInOrder) {
  const auto delay = read("{ kind = \"empirical\", samples_ms = [33.1, 0, 34] }");
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(delay).samples,
              ElementsAre(Duration(33'100'000), Duration(0), Duration(34'000'000)));
  EXPECT_TRUE(files_.empty());
}

TEST_F(InlineSamples, AreInATableWhoseFormIsShown) {
  expect_refusal(2, "delay", [&] { (void)read("37"); });
  EXPECT_THAT(bad_file_error([&] { (void)read("37"); }).what(),
              testing::HasSubstr("Write delay = { kind = \"constant\", ms = 37 }"));
}

TEST_F(InlineSamples, AreRefusedAtTheirLine) {
  for (const std::string sample : {"-2", "\"2\"", "nan", "6.1e4"})
    EXPECT_EQ(bad_file_error([&] {
                (void)read("{ kind = \"empirical\", samples_ms = [\n1,\n" + sample + "\n] }");
              })
                  .where()
                  .line,
              4)
        << sample;
}

TEST_F(InlineSamples, AreGivenOnceAndInOneWay) {
  const auto expect_refused = [&](const std::string& subject, const std::string& keys) {
    expect_refusal(2, subject, [&] { (void)read("{ kind = \"empirical\"" + keys + " }"); });
  };
  expect_refused("[camera.delay]", "");
  expect_refused("[camera.delay]", ", samples_ms = [1], file_s = \"p.toml\"");
  expect_refused("samples_ms", ", samples_ms = []");
  expect_refused("file_ms", ", file_ms = \"missing\"");
}

}  // namespace
}  // namespace tether::scenario
