// A program that knows nothing of Tether: reads /dev/video0 by V4L2 in each way that there is, and
// prints what it saw: "NAME VALUE…", times in µs. Exit code 1: something that must not fail did.
//
// usage: camera_program [late]; late: by its clock, others may hold it up between two images
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

constexpr unsigned kBuffers = 4;
constexpr unsigned kType = V4L2_BUF_TYPE_VIDEO_CAPTURE;

bool may_be_late = false;

long now_us() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<long>(t.tv_sec) * 1'000'000 + t.tv_nsec / 1000;
}

void must(bool is_true, const char* what) {
  if (is_true) return;
  std::printf("failed: %s: %s\n", what, std::strerror(errno));
  std::exit(1);
}

template <class Argument>
int ask(int fd, unsigned long request, Argument& argument) {
  return ioctl(fd, request, &argument) == 0 ? 0 : errno;
}

std::array<const unsigned char*, kBuffers> mapped;

v4l2_buffer buffer_of(unsigned index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = kType;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

int request(int fd) {
  v4l2_requestbuffers buffers{};
  buffers.count = kBuffers;
  buffers.type = kType;
  buffers.memory = V4L2_MEMORY_MMAP;
  return ask(fd, VIDIOC_REQBUFS, buffers);
}

void queue(int fd, unsigned index) {
  v4l2_buffer buffer = buffer_of(index);
  must(ask(fd, VIDIOC_QBUF, buffer) == 0, "QBUF");
}

// The error; else the image's number and age, and its buffer is queued again.
int take(int fd, const char* name, long since_us) {
  v4l2_buffer buffer = buffer_of(0);
  const int error = ask(fd, VIDIOC_DQBUF, buffer);
  if (error != 0) return error;
  const long stamp_us = buffer.timestamp.tv_sec * 1'000'000 + buffer.timestamp.tv_usec;
  long sum = 0;
  for (unsigned i = 0; i < buffer.bytesused; ++i) sum += mapped[buffer.index][i];
  std::printf("%s %u %ld %ld %d\n", name, buffer.sequence, now_us() - stamp_us, now_us() - since_us,
              sum > 0);
  queue(fd, buffer.index);
  return 0;
}

void stream(int fd) {
  must(request(fd) == 0, "REQBUFS");
  for (unsigned i = 0; i < kBuffers; ++i) {
    v4l2_buffer buffer = buffer_of(i);
    must(ask(fd, VIDIOC_QUERYBUF, buffer) == 0, "QUERYBUF");
    void* const memory = mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, fd, buffer.m.offset);
    must(memory != MAP_FAILED, "mmap");
    mapped[i] = static_cast<const unsigned char*>(memory);
    queue(fd, i);
  }
  unsigned type = kType;
  must(ask(fd, VIDIOC_STREAMON, type) == 0, "STREAMON");
}

void wait_in_each_way(int fd) {
  long begun = now_us();
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  must(select(fd + 1, &set, nullptr, nullptr, nullptr) == 1, "select");
  must(take(fd, "select", begun) == 0, "after select");
  begun = now_us();
  pollfd entry{fd, POLLIN, 0};
  must(poll(&entry, 1, 5) == 0 || may_be_late, "an image too early");
  must(poll(&entry, 1, -1) == 1 && (entry.revents & POLLIN) != 0, "poll");
  must(take(fd, "poll", begun) == 0, "after poll");
  begun = now_us();
  const int epoll = epoll_create1(EPOLL_CLOEXEC);
  epoll_event event{.events = EPOLLIN, .data = {}};
  must(epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event) == 0, "epoll_ctl");
  must(epoll_wait(epoll, &event, 1, 1000) == 1, "epoll");
  must(take(fd, "epoll", begun) == 0, "after epoll");
  must(take(fd, "", 0) == EAGAIN || may_be_late, "an image without waiting");
  begun = now_us();
  must(fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK) == 0, "F_SETFL");
  must(take(fd, "blocking", begun) == 0, "blocking");
}

// Images of while it computes stay in the buffers; those without one are lost.
void overflow(int fd) {
  for (const long begun = now_us(); now_us() - begun < 400'000;) {
  }
  const long since = now_us();
  for (unsigned i = 0; i <= kBuffers; ++i) must(take(fd, "late", since) == 0, "late");
}

}  // namespace

int main(int argc, char**) {
  may_be_late = argc > 1;
  struct stat status {};
  must(stat("/dev/video0", &status) == 0 && S_ISCHR(status.st_mode), "stat");
  must(access("/dev/video0", R_OK | W_OK) == 0, "access");
  must(access("/dev/video1", R_OK) == -1 && errno == ENOENT, "no second camera");
  const int fd = open("/dev/video0", O_RDWR | O_NONBLOCK);
  must(fd >= 0 && fstat(fd, &status) == 0 && S_ISCHR(status.st_mode), "open");
  char byte = 0;
  must(read(fd, &byte, 1) == -1 && errno == EINVAL, "read");
  stream(fd);
  const int second = open("/dev/video0", O_RDWR);
  must(second >= 0 && request(second) == EBUSY, "a second one");
  wait_in_each_way(fd);
  overflow(fd);
  const int copy = dup(fd);
  close(fd);
  must(take(copy, "copy", now_us()) == 0, "copy");
  close(copy);
  must(request(second) == 0, "the second one after the first");
  close(second);
}
