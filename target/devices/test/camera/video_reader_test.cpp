#include "camera/video_reader.h"

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
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/file_descriptor.h>

namespace tether::devices {
namespace {

const VideoReader& reader() {
  return *video_reader().value();
}

class VideoReaderTest : public testing::Test {
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

TEST_F(VideoReaderTest, GivesImagesInOrderAsRgb) {
  write_video(scratch_.path("a.avi"), {kRed, kRed, kBlue}, 12.0, {80, 48});
  const auto source = reader().open_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, 80);
  EXPECT_EQ(source->format().height_px, 48);
  EXPECT_NEAR(source->format().rate_hz, 12.0, 1e-3);
  uav::CameraSample image;
  ASSERT_TRUE(source->grab());
  ASSERT_TRUE(source->grab()) << "a skipped image need not be retrieved";
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(source->retrieve(image));
    ASSERT_EQ(image.rgb.size(), 3u * 80u * 48u);
    EXPECT_EQ(image.width_px, 80);
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

TEST_F(VideoReaderTest, GivesNoneForWhatItCannotOpen) {
  EXPECT_EQ(reader().open_file(scratch_.write("a.avi", "no video")), nullptr);
  EXPECT_EQ(reader().open_file(scratch_.write("empty.avi", "")), nullptr);
  EXPECT_EQ(reader().open_file(scratch_.path("missing.avi")), nullptr);
  EXPECT_EQ(reader().open_device("/dev/null", {}), nullptr);
  EXPECT_EQ(reader().open_device(scratch_.path("missing"), {}), nullptr);
}

TEST_F(VideoReaderTest, AStreamMayBeAFileToo) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue});
  const auto source = reader().open_stream("file://" + scratch_.path("a.avi").string(), 1000);
  ASSERT_NE(source, nullptr);
  EXPECT_TRUE(source->grab());
  EXPECT_TRUE(source->grab());
  EXPECT_FALSE(source->grab());
  EXPECT_EQ(reader().open_stream("file://" + scratch_.path("missing.avi").string(), 1000), nullptr);
}

// What the libraries behind it would write to the standard error (`write_video` makes a header of
// 4104 bytes, then 688 per image).

constexpr std::uintmax_t kInTheHeader = 600, kInTheFirstImage = 4200, kInTheSecondImage = 5000;

TEST_F(VideoReaderTest, ACutFileIsSilent) {
  for (const std::uintmax_t bytes : {kInTheHeader, kInTheFirstImage, kInTheSecondImage}) {
    const std::string path = cut_video(bytes);
    testing::internal::CaptureStderr();
    if (const auto source = reader().open_file(path)) {
      uav::CameraSample image;
      while (source->grab()) source->retrieve(image);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bytes;
  }
}

// In a process of its own, since the level is asked for once.
TEST(VideoReader, KeepsFfmpegsLogIfTheUserAsksForIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto refused_with = [](const char* variable, const char* value) {
    ::unsetenv("OPENCV_FFMPEG_LOGLEVEL");  // an earlier test's
    ::setenv(variable, value, 1);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // OpenCV writes it there if it is asked to
    reader().open_stream("http://127.0.0.1:1/x", 1000);
    std::fflush(nullptr);
    std::_Exit(0);
  };
  EXPECT_EXIT(refused_with("OPENCV_FFMPEG_LOGLEVEL", "16"), testing::ExitedWithCode(0), "refused");
  EXPECT_EXIT(refused_with("OPENCV_FFMPEG_DEBUG", "1"), testing::ExitedWithCode(0), "refused");
}

TEST_F(VideoReaderTest, ARefusedStreamIsSilent) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(reader().open_stream("http://127.0.0.1:1/x", 1000), nullptr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VideoReaderTest, StalledStreamEndsSilentlyAtItsTimeout) {
  write_video(scratch_.path("a.avi"), std::vector<cv::Scalar>(200, kRed));
  std::ifstream file(scratch_.path("a.avi"), std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const os::FileDescriptor listener(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof any;
  auto* address = reinterpret_cast<sockaddr*>(&any);
  ASSERT_EQ(::bind(listener.get(), address, size), 0);
  ASSERT_EQ(::listen(listener.get(), 1), 0);
  ASSERT_EQ(::getsockname(listener.get(), address, &size), 0);
  os::FileDescriptor client;  // gets half of the file, and then nothing
  std::thread serving([&] {
    client = os::FileDescriptor(::accept(listener.get(), nullptr, nullptr));
    ::send(client.get(), bytes.data(), bytes.size() / 2, MSG_NOSIGNAL);
  });
  testing::internal::CaptureStderr();
  const auto source =
      reader().open_stream("tcp://127.0.0.1:" + std::to_string(ntohs(any.sin_port)), 300);
  serving.join();
  EXPECT_NE(source, nullptr);
  int images = 0;
  while (source && source->grab()) ++images;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(images, 0);
}

}  // namespace
}  // namespace tether::devices
