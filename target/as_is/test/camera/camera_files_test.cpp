#include "camera/camera_files.h"

#include "camera_fixture.h"

#include <cerrno>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

class AsIsCameraFiles : public testing::Test {
 protected:
  AsIsCameraFiles() { files_.add(camera_of(), arrivals_.images()); }

  int request(int fd) {
    v4l2_requestbuffers buffers = buffers_of(2);
    return files_.answer(fd, VIDIOC_REQBUFS, &buffers);
  }
  void close(int fd) {
    files_.forget(fd);
    ::close(fd);
  }

  Arrivals arrivals_{Duration(0)};
  CameraFiles files_;
};

TEST_F(AsIsCameraFiles, KnowsThePathsOfCameras) {
  EXPECT_EQ(CameraFiles::number_of("/dev/video0"), 0U);
  EXPECT_EQ(CameraFiles::number_of("/dev/video12"), 12U);
  for (const char* other : {"/dev/video", "/dev/video0x", "/dev/null", ""})
    EXPECT_FALSE(CameraFiles::number_of(other)) << other;
  EXPECT_FALSE(CameraFiles::number_of(nullptr));
}

TEST_F(AsIsCameraFiles, ThereAreAsManyAsTheUavHas) {
  EXPECT_EQ(files_.open(1, O_RDWR), -1);
  EXPECT_EQ(errno, ENOENT);
  const int fd = files_.open(0, O_RDWR | O_NONBLOCK);
  EXPECT_TRUE(files_.is_ours(fd));
  EXPECT_TRUE(::fcntl(fd, F_GETFL) & O_NONBLOCK);
  EXPECT_FALSE(files_.is_ours(fd + 1));
  close(fd);
  EXPECT_FALSE(files_.is_ours(fd));
  EXPECT_FALSE(files_.is_any());
}

TEST_F(AsIsCameraFiles, ASecondOpenerCannotStreamUntilTheFirstOneCloses) {
  const int first = files_.open(0, O_RDWR), second = files_.open(0, O_RDWR);
  EXPECT_EQ(request(first), 0);
  EXPECT_EQ(request(second), EBUSY);
  close(first);
  EXPECT_EQ(request(second), 0);
  close(second);
}

TEST_F(AsIsCameraFiles, ACopyOfADescriptorIsTheSameFile) {
  const int fd = files_.open(0, O_RDWR);
  const int copy = ::dup(fd);
  files_.copy(fd, copy);
  EXPECT_EQ(request(fd), 0);
  close(fd);
  EXPECT_EQ(request(copy), 0) << "still open";
  EXPECT_TRUE(files_.is_any());
  close(copy);
  EXPECT_FALSE(files_.is_any());
}

}  // namespace
}  // namespace tether::as_is
