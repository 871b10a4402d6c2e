#include "random_message.h"

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <tether/link/socket.h>
#include <tether/sim_protocol/codec.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim::protocol {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using Kind = Failure::Kind;

std::filesystem::path socket_path() {
  static int count = 0;
  return std::filesystem::temp_directory_path() /
         ("tether-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".sock");
}

Open open() {
  Open open;
  open.step = milliseconds(1);
  open.max_width_px = 640;
  open.max_height_px = 480;
  return open;
}

/// Both ends of a connection, over either kind of socket. The system's queue holds a connection
/// that nobody has accepted yet, so that one thread can be both.
class ConnectionTest : public testing::TestWithParam<const char*> {
 protected:
  ConnectionTest() {
    const bool tcp = GetParam() == std::string("tcp");
    listener_ =
        listen(tcp ? Endpoint(link::Address{"127.0.0.1", 0}) : Endpoint(socket_path())).value();
    host_ = connect(listener_->endpoint(), seconds(10)).value();
    simulator_ = listener_->accept().value();
  }
  void open_both() {
    ASSERT_TRUE(host_->send(Request(open())).ok());
    ASSERT_TRUE(simulator_->receive_request().ok());
    ASSERT_TRUE(simulator_->send(Reply(Opened{"test", {}})).ok());
    ASSERT_TRUE(host_->receive_reply(seconds(10)).ok());
  }

  std::unique_ptr<Listener> listener_;
  std::unique_ptr<Connection> host_;
  std::unique_ptr<Connection> simulator_;
};

INSTANTIATE_TEST_SUITE_P(Sockets, ConnectionTest, testing::Values("unix", "tcp"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(ConnectionTest, CarriesAPictureThatNoSocketBufferHolds) {
  open_both();
  Render render;
  render.camera = uav::CameraModel::from_horizontal_fov(640, 480, 1.0);
  ASSERT_TRUE(host_->send(Request(render)).ok());
  ASSERT_TRUE(simulator_->receive_request().ok());
  Picture picture{640, 480, std::vector<std::uint8_t>(640 * 480 * 3), 0.0, "test"};
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    picture.rgb[i] = static_cast<std::uint8_t>(i * 7 % 251);
  }
  std::thread sender([&] { EXPECT_TRUE(simulator_->send(Reply(picture)).ok()); });
  const auto reply = host_->receive_reply(seconds(30));
  sender.join();
  EXPECT_EQ(std::get<Picture>(reply.value()).rgb, picture.rgb);
}

TEST_P(ConnectionTest, SilenceTimesOutAndTheAnswerMayStillCome) {
  ASSERT_TRUE(host_->send(Request(open())).ok());
  EXPECT_EQ(host_->receive_reply(milliseconds(1)).failure().kind, Kind::kTimeout);
  ASSERT_TRUE(simulator_->send(Reply(Opened{"late", {}})).ok());
  EXPECT_TRUE(host_->receive_reply(seconds(10)).ok());
}

TEST_P(ConnectionTest, SendsNothingInvalid) {
  EXPECT_EQ(host_->send(Request(Open{})).failure().kind, Kind::kInvalid);
  EXPECT_EQ(simulator_->send(Reply(Picture{})).failure().kind, Kind::kInvalid);
  open_both();
}

TEST_P(ConnectionTest, ReportsARefusedRequestToTheHost) {
  Open other = open();
  other.version = 99;
  ASSERT_TRUE(host_->send(Request(other)).ok());
  EXPECT_EQ(simulator_->receive_request().failure().kind, Kind::kProtocol);
  const auto reply = host_->receive_reply(seconds(10));
  EXPECT_THAT(std::get<Failed>(reply.value()).message, HasSubstr("99"));
}

TEST_P(ConnectionTest, RefusesAReplyToAnotherRequest) {
  ASSERT_TRUE(host_->send(Request(open())).ok());
  ASSERT_TRUE(simulator_->send(Reply(Distances{})).ok());
  EXPECT_EQ(host_->receive_reply(seconds(10)).failure().kind, Kind::kProtocol);
}

TEST_P(ConnectionTest, ClosingWakesTheReceiverOnEitherEnd) {
  auto here = std::async(std::launch::async, [this] { return host_->receive_reply(seconds(60)); });
  auto there = std::async(std::launch::async, [this] { return simulator_->receive_request(); });
  host_->close();
  EXPECT_EQ(here.get().failure().kind, Kind::kDisconnected);
  EXPECT_EQ(there.get().failure().kind, Kind::kDisconnected);
}

TEST_P(ConnectionTest, ClosingWakesTheSender) {
  const Reply picture = Picture{4000, 4000, std::vector<std::uint8_t>(48'000'000), 0.0, ""};
  auto sent = std::async(std::launch::async, [&] { return simulator_->send(picture); });
  simulator_->close();
  EXPECT_EQ(sent.get().failure().kind, Kind::kDisconnected);
}

TEST_P(ConnectionTest, ClosingWakesTheListener) {
  auto accepted = std::async(std::launch::async, [this] { return listener_->accept().ok(); });
  listener_->close();
  EXPECT_FALSE(accepted.get());
  EXPECT_EQ(listener_->accept().failure().kind, Kind::kDisconnected);
}

TEST_P(ConnectionTest, TakesHostsOneAfterTheOther) {
  host_->close();
  EXPECT_EQ(simulator_->receive_request().failure().kind, Kind::kDisconnected);
  host_ = connect(listener_->endpoint(), seconds(10)).value();
  simulator_ = listener_->accept().value();
  open_both();
}

// ---- a peer that is not a simulator ------------------------------------------------------------

/// A peer that can send any bytes.
class RawSimulator {
 public:
  RawSimulator() : listener_(link::listen_on_tcp({"127.0.0.1", 0}).value()) {
    host = connect(link::local_address(listener_.get()), seconds(10)).value();
    socket_ = link::Descriptor(::accept(listener_.get(), nullptr, nullptr));
  }
  void write(std::span<const std::uint8_t> bytes) {
    const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    EXPECT_EQ(sent, static_cast<ssize_t>(bytes.size()));
  }
  void hang_up() { ::shutdown(socket_.get(), SHUT_RDWR); }

  std::unique_ptr<Connection> host;

 private:
  link::Descriptor listener_, socket_;
};

TEST(RawPeer, ThatDisconnectsWithinAFrameIsGone) {
  RawSimulator simulator;
  Encoder encoder;
  const auto frame = frame_of(encoder, Reply(Failed{"some text"}));
  simulator.write(std::span(frame).first(frame.size() - 1));
  simulator.hang_up();
  EXPECT_EQ(simulator.host->receive_reply(seconds(10)).failure().kind, Kind::kDisconnected);
}

TEST(RawPeer, ThatStopsWithinAFrameTimesOut) {
  RawSimulator simulator;
  Encoder encoder;
  const auto frame = frame_of(encoder, Reply(Failed{"some text"}));
  simulator.write(std::span(frame).first(7));
  EXPECT_EQ(simulator.host->receive_reply(milliseconds(1)).failure().kind, Kind::kTimeout);
  simulator.write(std::span(frame).subspan(7));
  const auto reply = simulator.host->receive_reply(seconds(10));
  EXPECT_EQ(std::get<Failed>(reply.value()).message, "some text");
}

TEST(RawPeer, ThatSendsNoFrameIsRefused) {
  for (const std::string bytes :
       {"\xff\xff\xff\x7f", "SSH-2.0-OpenSSH_9.2p1 Debian-2\r\n"}) {  // too long; not a length
    RawSimulator simulator;
    simulator.write({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_EQ(simulator.host->receive_reply(seconds(10)).failure().kind, Kind::kProtocol);
  }
}

// ---- where to listen ---------------------------------------------------------------------------

/// A Unix socket of a simulator that does nothing with it.
link::Descriptor bound_to(const std::filesystem::path& path) {
  link::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return socket;
}

TEST(UnixListener, IsForItsOwnerOnlyAndRemovesItsFile) {
  const auto path = socket_path();
  auto listener = listen(Endpoint(path)).value();
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  listener.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(UnixListener, ReplacesASocketWithoutAListenerOnly) {
  const auto path = socket_path();
  bound_to(path);  // and closed
  ASSERT_TRUE(std::filesystem::exists(path));
  const auto listener = listen(Endpoint(path)).value();
  EXPECT_TRUE(connect(Endpoint(path), seconds(10)).ok());
  const auto second = listen(Endpoint(path));
  EXPECT_EQ(second.failure().kind, Kind::kInvalid);
  EXPECT_THAT(second.failure().message, HasSubstr(path.string()));
  EXPECT_TRUE(connect(Endpoint(path), seconds(10)).ok());

  const auto file = socket_path();
  std::ofstream(file) << "precious";
  EXPECT_FALSE(listen(Endpoint(file)).ok());
  EXPECT_EQ(std::filesystem::file_size(file), 8u);
  std::filesystem::remove(file);
}

TEST(UnixListener, RefusesAPathThatIsTooLong) {
  const Endpoint endpoint(std::filesystem::path("/tmp/" + std::string(200, 'x')));
  for (const Failure& failure :
       {listen(endpoint).failure(), connect(endpoint, seconds(1)).failure()}) {
    EXPECT_EQ(failure.kind, Kind::kInvalid);
    EXPECT_THAT(failure.message, HasSubstr("107 bytes"));
  }
}

TEST(Connect, FailsWithoutAListener) {
  const Endpoint tcp = listen(link::Address{"127.0.0.1", 0}).value()->endpoint();  // and closed
  for (const Endpoint& nobody : {Endpoint(socket_path()), tcp}) {
    const Failure failure = connect(nobody, seconds(10)).failure();
    EXPECT_EQ(failure.kind, Kind::kDisconnected);
    EXPECT_THAT(failure.message, HasSubstr(nobody.index() == 0 ? to_string(nobody) : "127.0.0.1:"));
  }
}

TEST(Connect, TimesOutIfTooManyWait) {
  const auto path = socket_path();
  const link::Descriptor busy = bound_to(path);
  ASSERT_EQ(::listen(busy.get(), 0), 0);
  const auto waiting = connect(Endpoint(path), seconds(10));
  EXPECT_TRUE(waiting.ok());
  EXPECT_EQ(connect(Endpoint(path), milliseconds(1)).failure().kind, Kind::kTimeout);
  std::filesystem::remove(path);
}

TEST(TcpListener, RefusesAPortInUse) {
  const auto listener = listen(Endpoint(link::Address{"127.0.0.1", 0})).value();
  EXPECT_EQ(listen(listener->endpoint()).failure().kind, Kind::kInvalid);
}

}  // namespace
}  // namespace tether::sim::protocol
