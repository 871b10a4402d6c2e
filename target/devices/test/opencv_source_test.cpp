#include "opencv_source.h"

#include "video_file.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

const cv::Scalar kRed(0, 0, 250);
const cv::Scalar kBlue(250, 0, 0);

class OpencvSourceTest : public testing::Test {
 protected:
  /// A video of one image and a bit, cut there.
  std::string cut_video(std::uintmax_t bytes) {
    const std::string path = scratch_.path("cut.avi");
    write_video(path, {kRed, kRed, kRed});
    std::filesystem::resize_file(path, bytes);
    return path;
  }
  ScratchFolder scratch_;
};

TEST_F(OpencvSourceTest, SaysTheFormatOfAFile) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue}, 12.0, {80, 48});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, 80);
  EXPECT_EQ(source->format().height_px, 48);
  EXPECT_NEAR(source->format().rate_hz, 12.0, 1e-3);
}

TEST_F(OpencvSourceTest, GivesImagesInOrderAsRgb) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  uav::CameraSample image;
  ASSERT_TRUE(source->grab());
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(source->retrieve(image));
    ASSERT_EQ(image.rgb.size(), 3u * 64u * 48u);
    EXPECT_EQ(image.width_px, 64);
    EXPECT_EQ(image.height_px, 48);
    EXPECT_GT(image.rgb[0], 230);
    EXPECT_LT(image.rgb[2], 20);
  }
  ASSERT_TRUE(source->grab());
  ASSERT_TRUE(source->retrieve(image));
  EXPECT_LT(image.rgb[0], 20);
  EXPECT_GT(image.rgb[2], 230);
  EXPECT_FALSE(source->grab());
  EXPECT_FALSE(source->grab());
}

TEST_F(OpencvSourceTest, SkippedImagesNeedNotBeRetrieved) {
  write_video(scratch_.path("a.avi"), {kRed, kRed, kRed, kBlue});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(source->grab());
  uav::CameraSample image;
  ASSERT_TRUE(source->retrieve(image));
  EXPECT_GT(image.rgb[2], 230);
}

TEST_F(OpencvSourceTest, GivesNoneForWhatItCannotOpen) {
  EXPECT_EQ(open_video_file(scratch_.write("a.avi", "no video")), nullptr);
  EXPECT_EQ(open_video_file(scratch_.write("empty.avi", "")), nullptr);
  EXPECT_EQ(open_video_file(scratch_.path("missing.avi")), nullptr);
  EXPECT_EQ(open_video4linux("/dev/null", {}), nullptr);
  EXPECT_EQ(open_video4linux(scratch_.path("missing"), {}), nullptr);
}

TEST_F(OpencvSourceTest, AStreamMayBeAFileToo) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue});
  const auto source = open_stream("file://" + scratch_.path("a.avi").string(), 1000);
  ASSERT_NE(source, nullptr);
  EXPECT_TRUE(source->grab());
  EXPECT_TRUE(source->grab());
  EXPECT_FALSE(source->grab());
  EXPECT_EQ(open_stream("file://" + scratch_.path("missing.avi").string(), 1000), nullptr);
}

// What the libraries behind it would write to the standard error (`write_video` makes a header of
// 4104 bytes, then 688 per image).

constexpr std::uintmax_t kInTheHeader = 600, kInTheFirstImage = 4200, kInTheSecondImage = 5000;

TEST_F(OpencvSourceTest, ACutFileIsSilent) {
  for (const std::uintmax_t bytes : {kInTheHeader, kInTheFirstImage, kInTheSecondImage}) {
    const std::string path = cut_video(bytes);
    testing::internal::CaptureStderr();
    if (const auto source = open_video_file(path)) {
      uav::CameraSample image;
      while (source->grab()) source->retrieve(image);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bytes;
  }
}

// In a process of its own, since the level is asked for once.
TEST(OpencvSource, WhoeverAsksForFfmpegsLogGetsIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto refused_with = [](const char* variable, const char* value) {
    ::unsetenv("OPENCV_FFMPEG_LOGLEVEL");  // an earlier test's
    ::setenv(variable, value, 1);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // OpenCV writes it there if it is asked to
    open_stream("http://127.0.0.1:1/x", 1000);
    std::fflush(nullptr);
    std::_Exit(0);
  };
  EXPECT_EXIT(refused_with("OPENCV_FFMPEG_LOGLEVEL", "16"), testing::ExitedWithCode(0), "refused");
  EXPECT_EXIT(refused_with("OPENCV_FFMPEG_DEBUG", "1"), testing::ExitedWithCode(0), "refused");
}

TEST_F(OpencvSourceTest, ARefusedStreamIsSilent) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(open_stream("http://127.0.0.1:1/x", 1000), nullptr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// Gives its one client these bytes, and then nothing, but does not hang up.
class StallingServer {
 public:
  StallingServer() {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof any;
    auto* address = reinterpret_cast<sockaddr*>(&any);
    EXPECT_EQ(::bind(listener_, address, size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    EXPECT_EQ(::getsockname(listener_, address, &size), 0);
    url_ = "tcp://127.0.0.1:" + std::to_string(ntohs(any.sin_port));
  }
  ~StallingServer() {
    if (client_ >= 0) ::close(client_);
    ::close(listener_);
  }
  const std::string& url() const { return url_; }
  void serve(const std::string& bytes) {
    client_ = ::accept(listener_, nullptr, nullptr);
    EXPECT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  int listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  int client_ = -1;
  std::string url_;
};

TEST_F(OpencvSourceTest, AStreamThatStallsIsSilent) {
  write_video(scratch_.path("a.avi"), std::vector<cv::Scalar>(200, kRed));
  std::ifstream file(scratch_.path("a.avi"), std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  StallingServer server;
  std::thread serving([&] { server.serve(bytes.substr(0, bytes.size() / 2)); });
  testing::internal::CaptureStderr();
  const auto source = open_stream(server.url(), 300);
  serving.join();
  EXPECT_NE(source, nullptr);
  int images = 0;
  while (source && source->grab()) ++images;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(images, 0);
}

}  // namespace
}  // namespace tether::devices
