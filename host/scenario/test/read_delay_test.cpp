#include "read_delay.h"

#include "full_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class DelaySamples : public testing::Test {
 protected:
  std::string error_of(const std::string& text) const {
    const auto file = scratch_.write("d.txt", text);
    return bad_file_message([&] { (void)read_delay_samples(file, 1e-3); });
  }
  ScratchFolder scratch_;
};

TEST_F(DelaySamples, SkipsBlankLinesAndComments) {
  const auto file = scratch_.write("d.txt", "# measured 2024\r\n\n 0.0374 \r\n  # more\n0\n1e-3");
  EXPECT_THAT(read_delay_samples(file, 1.0),
              ElementsAre(Duration(37'400'000), Duration(0), Duration(1'000'000)));
}

TEST_F(DelaySamples, NamesTheLineOfWhatIsNoDelay) {
  EXPECT_THAT(error_of("1\n2\nthree\n"), HasSubstr("d.txt:3: expected one number"));
  EXPECT_THAT(error_of("1\n2 3\n"), HasSubstr("d.txt:2: expected one number"));
  EXPECT_THAT(error_of("-0.5\n"), HasSubstr("d.txt:1: a delay must be at least 0"));
  EXPECT_THAT(error_of("nan\n"), HasSubstr("d.txt:1: "));
  EXPECT_THAT(error_of("1e9\n"), HasSubstr("at most 60000"));
  EXPECT_THAT(error_of("0x10\n"), HasSubstr("expected one number"));
}

TEST_F(DelaySamples, MayBeginWithAByteOrderMark) {
  const auto file = scratch_.write("d.txt", "\xEF\xBB\xBF# of Windows\r\n2\r\n");
  EXPECT_THAT(read_delay_samples(file, 1e-3), ElementsAre(Duration(2'000'000)));
  EXPECT_THAT(error_of("1\n\xEF\xBB\xBF"
                       "2\n"),
              HasSubstr("d.txt:2: "));
  EXPECT_THAT(error_of("\xEF\xBB\xBF"), HasSubstr("holds no delay"));
}

TEST_F(DelaySamples, ShowsBytesThatCannotBePrinted) {
  EXPECT_THAT(error_of(std::string("1\0\r2\x1B[31m\t\xE9\x7F\n", 14)),
              EndsWith("found \"1\\x00\\x0D2\\x1B[31m\\x09\\xE9\\x7F\""));
  EXPECT_THAT(error_of(std::string(41, 'a')), EndsWith('"' + std::string(40, 'a') + "…\""));
  EXPECT_THAT(error_of(std::string(40, 'a')), EndsWith('"' + std::string(40, 'a') + "\""));
}

TEST_F(DelaySamples, RefusesWhatIsNoFile) {
  const auto error_at = [](const std::filesystem::path& path) {
    return bad_file_message([&] { (void)read_delay_samples(path, 1e-3); });
  };
  EXPECT_THAT(error_at(scratch_.path("missing")), HasSubstr("there is no such file"));
  ASSERT_EQ(::mkfifo(scratch_.path("pipe").c_str(), 0600), 0);
  for (const auto& path :
       {scratch_.path(), scratch_.path("pipe"), std::filesystem::path("/dev/zero")})
    EXPECT_THAT(error_at(path), HasSubstr("that is no regular file"));
}

TEST_F(DelaySamples, RefusesAFileWithoutAny) {
  EXPECT_THAT(error_of(""), HasSubstr("holds no delay"));
  EXPECT_THAT(error_of("# nothing\n\n"), HasSubstr("holds no delay"));
}

class InlineSamples : public testing::Test {
 protected:
  /// The delay of a sensor with that text.
  uav::Delay read(const std::string& text) {
    const auto file = scratch_.write("p.toml", "[camera]\ndelay = " + text + "\n");
    const toml::Document document = toml::Document::load(file);
    return read_delay(document.root().table("camera"), files_);
  }
  std::string error_of(const std::string& text) {
    return bad_file_message([&] { (void)read(text); });
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

TEST_F(InlineSamples, NameTheLineOfWhatIsNoDelay) {
  const auto samples = [](const std::string& text) {
    return "{ kind = \"empirical\", samples_ms = [\n1,\n" + text + "\n] }";
  };
  EXPECT_THAT(error_of(samples("-2")),
              HasSubstr("p.toml:4: 'samples_ms' of [camera.delay] must be numbers of at least 0 "
                        "and at most 60000, but has the integer -2"));
  EXPECT_THAT(error_of(samples("\"2\"")), HasSubstr("p.toml:4: "));
  EXPECT_THAT(error_of(samples("nan")), HasSubstr("p.toml:4: "));
  EXPECT_THAT(error_of(samples("6e4, 6.1e4")), HasSubstr("but has the number 61000"));
}

TEST_F(InlineSamples, RefuseToBeEmptyOrTwice) {
  EXPECT_THAT(error_of("{ kind = \"empirical\", samples_ms = [] }"),
              HasSubstr("p.toml:2: 'samples_ms' of [camera.delay] must hold at least one number"));
  EXPECT_THAT(error_of("{ kind = \"empirical\", samples_ms = [1], file_s = \"p.toml\" }"),
              HasSubstr("p.toml:2: [camera.delay] needs one of 'samples_ms'"));
  EXPECT_THAT(error_of("{ kind = \"empirical\" }"), HasSubstr("needs one of 'samples_ms'"));
}

TEST_F(InlineSamples, AFileOfThemMustBeOne) {
  EXPECT_THAT(error_of("{ kind = \"empirical\", file_ms = \"missing\" }"),
              HasSubstr("p.toml:2: 'file_ms' of [camera.delay] names \"missing\", but there is no "
                        "such file ("));
  EXPECT_THAT(error_of("{ kind = \"empirical\", file_ms = \".\" }"),
              HasSubstr("names \".\", but that is no regular file ("));
}

}  // namespace
}  // namespace tether::scenario
