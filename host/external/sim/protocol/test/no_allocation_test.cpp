#include "random_message.h"

#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>
#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

// What goes to and fro once a world is open, twice: by the second time the encoder's buffer is
// large enough.
template <class BeforeFlight, class Message, class Draw>
void expect_steady_encoding(Draw draw) {
  std::vector<Message> messages;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Message message = draw(i);
    if (!std::holds_alternative<BeforeFlight>(message)) messages.push_back(std::move(message));
  }
  Encoder encoder;
  std::size_t bytes = 0;
  const auto encode_all = [&] {
    for (const Message& message : messages) bytes += encoder.encode(message).size();
  };
  encode_all();
  AllocationCount count;
  encode_all();
  EXPECT_EQ(count.stop(), 0);
  EXPECT_GT(messages.size(), 200u);
  EXPECT_GT(bytes, 2 * messages.size());
}

TEST(NoAllocation, EncodingAllocatesNothingInSteadyUse) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  expect_steady_encoding<Open, Request>([](std::uint64_t i) { return RandomMessage(i).request(); });
  expect_steady_encoding<Opened, Reply>([](std::uint64_t i) {
    Reply reply = RandomMessage(i).reply();
    if (auto* state = std::get_if<State>(&reply)) state->touches.clear();  // they are rare
    return reply;
  });
}

}  // namespace
}  // namespace tether::sim::protocol
