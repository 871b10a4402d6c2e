#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/client/exec/local_socket.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;

class LocalSocketTest : public testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    here_ = LocalSocket(os::FileDescriptor(ends[0]));
    there_ = LocalSocket(os::FileDescriptor(ends[1]));
  }
  LocalSocket here_{os::FileDescriptor()};
  LocalSocket there_{os::FileDescriptor()};
};

link::Message image_reply(int width_px, int height_px) {
  uav::CameraSample image{{}, 7, width_px, height_px, {}};
  image.rgb.resize(static_cast<std::size_t>(width_px * height_px * 3));
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = static_cast<std::uint8_t>(i * i);
  return link::Reply{3, ExecTime(5ms), image};
}

// A receiver that is frozen takes nothing out of the socket: whatever its size, a message must go
// in whole.
TEST_F(LocalSocketTest, MessagesOfAnySizeArriveComplete) {
  for (const int width_px : {4, 50, 640, 4096}) {
    const auto sent = image_reply(width_px, width_px * 3 / 4);
    ASSERT_TRUE(here_.send(sent).ok()) << width_px;
    auto packet = there_.receive(0ns);
    ASSERT_TRUE(packet.ok()) << packet.failure().message;
    ASSERT_TRUE(packet->message);
    const auto& reply = std::get<link::Reply>(*packet->message);
    EXPECT_EQ(reply.sequence, 3u);
    EXPECT_EQ(std::get<uav::CameraSample>(*reply.sample).rgb,
              std::get<uav::CameraSample>(*std::get<link::Reply>(sent).sample).rgb);
  }
  const std::string json = "{\"text\": \"" + std::string(900'000, 'x') + "\"}";
  ASSERT_TRUE(there_.send(link::Annotation{{}, "log", json}).ok());
  EXPECT_EQ(std::get<link::Annotation>(*here_.receive()->message).json, json);
}

TEST_F(LocalSocketTest, CarriesTheClock) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const os::FileDescriptor reading(ends[0]), writing(ends[1]);
  ASSERT_TRUE(here_.send_clock(writing).ok());
  auto packet = there_.receive();
  ASSERT_TRUE(packet.ok());
  EXPECT_FALSE(packet->message);
  ASSERT_EQ(::write(packet->clock_page.get(), "x", 1), 1);
  char byte = 0;
  EXPECT_EQ(::read(reading.get(), &byte, 1), 1);
}

TEST_F(LocalSocketTest, FailsWithTheRightKind) {
  EXPECT_EQ(here_.receive().failure().kind, Failure::Kind::kTimeout);
  EXPECT_EQ(here_.receive(1ms).failure().kind, Failure::Kind::kTimeout);
  EXPECT_EQ(here_.send(link::Progress{ExecTime(-1ns)}).failure().kind, Failure::Kind::kInvalid);

  ASSERT_EQ(::send(there_.descriptor(), "nonsense", 8, 0), 8);
  EXPECT_EQ(here_.receive().failure().kind, Failure::Kind::kProtocol);

  there_.shut_down();
  EXPECT_EQ(here_.receive().failure().kind, Failure::Kind::kDisconnected);
  EXPECT_EQ(here_.send(link::Progress{}).failure().kind, Failure::Kind::kDisconnected);
  EXPECT_EQ(connect_local("/nowhere/socket").failure().kind, Failure::Kind::kDisconnected);
  EXPECT_EQ(connect_local(std::string(200, 'x')).failure().kind, Failure::Kind::kInvalid);
  EXPECT_EQ(listen_local("/nowhere/socket").failure().kind, Failure::Kind::kInvalid);
}

// The sender of a piece of memory could cut it while it is read, were it not sealed.
TEST_F(LocalSocketTest, MemoryThatIsNotSealedIsRefused) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const os::FileDescriptor reading(ends[0]), writing(ends[1]);
  const std::uint8_t zeros[4] = {};
  iovec part{const_cast<std::uint8_t*>(zeros), sizeof zeros};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control;
  header.msg_controllen = sizeof control;
  cmsghdr* const rights = CMSG_FIRSTHDR(&header);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  *reinterpret_cast<int*>(CMSG_DATA(rights)) = reading.get();
  ASSERT_EQ(::sendmsg(there_.descriptor(), &header, 0), 4);
  EXPECT_EQ(here_.receive().failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::client
