#include "link_seeds.h"

#include "common/link/test/random_message.h"
#include "seed_file.h"

#include <tether/link/codec.h>

namespace tether::fuzz {
namespace {

using link::Message;

constexpr std::uint64_t kMessages = 24;
/// What `link_client` asks: three rounds of three reads, a command and a sleep; then the end.
constexpr std::uint64_t kRequests = 16;

void add(SeedFile& seed, const Message& message) {
  link::Encoder encoder;
  seed.add(encoder.encode(message));
}

Message welcome(bool free_running) {
  link::Welcome welcome;
  welcome.free_running = free_running;
  welcome.catalogue.uav = "uav";
  uav::CameraModel camera;
  camera.width_px = 4;
  camera.height_px = 2;
  camera.fx_px = camera.fy_px = 3.0;
  welcome.catalogue.sensors = {{"camera", {}, 30.0, uav::CameraProperties{camera}},
                               {"imu", {}, 20.0, uav::ImuProperties{}},
                               {"down", {}, 10.0, uav::RangeProperties{0.1, 8.0}}};
  welcome.catalogue.anchors = {{"box", uav::AnchorShape::kBox, {1, 1, 1}, {0, 0, 1}}};
  return welcome;
}

Message reply(std::uint64_t sequence) {
  link::Reply reply{sequence, from_ns<ExecTime>(static_cast<std::int64_t>(sequence) * 10), {}};
  const SimTime at{};
  switch (sequence % 5) {
    case 1:
      reply.sample = uav::CameraSample{at, sequence, 4, 2, std::vector<std::uint8_t>(24, 5)};
      break;
    case 2:
      reply.sample = uav::ImuSample{at, sequence, {1, 2, 3}, {}, {}};
      break;
    case 3:
      reply.sample = uav::RangeSample{at, sequence, 1.5};
      break;
    default:
      break;
  }
  if (sequence == kRequests) reply.sample.reset();
  return reply;
}

/// As the server's target takes it: pieces with their lengths before them.
void add_in_pieces(SeedFile& seed, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::size_t eights = std::min<std::size_t>((bytes.size() - 1) / 8, 255);
    seed.byte(static_cast<unsigned>(eights)).add(bytes.first(eights * 8 + 1));
    bytes = bytes.subspan(eights * 8 + 1);
  }
}

/// More lists within each other than anybody reads, from a SUT that sends what it must not.
void write_deep_details(const std::filesystem::path& folder) {
  link::Request request;
  request.sequence = 1;
  request.body = link::Finish{true, "done", "{\"a\":" + std::string(2000, '[')};
  link::Encoder encoder;
  const auto frame = encoder.encode(request);
  SeedFile().byte(1).byte(255).add(frame).write(folder, "link_frames", "deep-details");
}

void write_conversation(const std::filesystem::path& folder, bool free_running) {
  SeedFile to_client;
  add(to_client, welcome(free_running));
  for (std::uint64_t i = 1; i <= kRequests; ++i) add(to_client, reply(i));
  to_client.write(folder, "link_client", free_running ? "free" : "tied");
}

}  // namespace

void write_link_seeds(const std::filesystem::path& folder) {
  write_conversation(folder, false);
  write_conversation(folder, true);
  write_deep_details(folder);
  SeedFile refused;
  add(refused, link::Refusal{link::Refusal::Reason::kToken, "wrong token"});
  refused.write(folder, "link_client", "refused");
  link::Encoder encoder;
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    const std::string name = "message-" + std::to_string(i);
    const Message message = link::RandomMessage(i).draw(static_cast<std::uint32_t>(i % 8));
    const auto frame = encoder.encode(message);
    SeedFile().byte(1).byte(255).add(frame).write(folder, "link_frames", name);
    SeedFile to_server;
    to_server.byte(static_cast<unsigned>(i % 2));
    add_in_pieces(to_server, frame);
    to_server.write(folder, "link_server", name);
  }
}

}  // namespace tether::fuzz
