#include "random_message.h"

#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>
#include <tether/link/codec.h>

namespace tether::link {
namespace {

// What goes to and fro while a UAV flies, twice: by the second time the encoder's buffer is large
// enough.
TEST(NoAllocation, EncodingAllocatesNothingInSteadyUse) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  std::vector<Message> messages;
  for (std::uint64_t i = 0; i < 500; ++i) {
    Message message = RandomMessage(i).draw();
    const bool in_flight =
        std::holds_alternative<Request>(message) || std::holds_alternative<Reply>(message) ||
        std::holds_alternative<Progress>(message) || std::holds_alternative<Due>(message);
    if (in_flight) messages.push_back(std::move(message));
  }
  Encoder encoder;
  std::size_t bytes = 0;
  const auto encode_all = [&] {
    for (const Message& message : messages) bytes += encoder.encode_pieces(message).size();
  };
  encode_all();
  AllocationCount count;
  encode_all();
  EXPECT_EQ(count.stop(), 0);
  EXPECT_GT(messages.size(), 200u);
  EXPECT_GT(bytes, 2 * messages.size() * kFrameHeaderBytes);
}

}  // namespace
}  // namespace tether::link
