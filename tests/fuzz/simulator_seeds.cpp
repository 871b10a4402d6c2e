#include "simulator_seeds.h"

#include "host/sim/protocol/test/random_message.h"
#include "seed_file.h"
#include "simulator_script.h"

#include <tether/sim_protocol/codec.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_remote_testing/fake_outside.h>

namespace tether::fuzz {
namespace {

namespace protocol = sim::protocol;

constexpr std::uint64_t kMessages = 20;

template <class Message>
void add(SeedFile& seed, const Message& message) {
  protocol::Encoder encoder;
  const link::FramePieces frame = encoder.encode(message);
  seed.add(frame.head).add(frame.image).add(frame.tail);
}

/// What is said between the host and a simulator outside while it flies the script.
void write_conversation(const std::filesystem::path& folder) {
  SeedFile answers, requests;
  const sim::World world = scripted_world();
  sim::testing::FakeOutside outside(world, [&](const auto& request, protocol::Reply answer) {
    add(requests, request);
    add(answers, answer);
    return answer;
  });
  const auto simulator =
      sim::make_remote_simulator(world, outside.take_connection(), {}, [](const std::string&) {});
  fly_script(*simulator);
  answers.write(folder, "simulator_host", "flight");
  requests.write(folder, "simulator_outside", "flight");
}

}  // namespace

void write_simulator_seeds(const std::filesystem::path& folder) {
  write_conversation(folder);
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    const auto kind = static_cast<std::uint32_t>(i % 5);
    SeedFile request, reply;
    add(request.byte(255), protocol::RandomMessage(i).request(kind));
    add(reply.byte(255), protocol::RandomMessage(i).reply(kind));
    request.write(folder, "simulator_frames", "request-" + std::to_string(i));
    reply.write(folder, "simulator_frames", "reply-" + std::to_string(i));
  }
}

}  // namespace tether::fuzz
