#pragma once

#include <cstdint>
#include <vector>

#include <tether/sim_protocol/messages.h>

namespace tether::system_test {

/// What a simulator outside answers in whose world nothing ever moves.
class StillWorld {
 public:
  sim::protocol::Reply answer(const sim::protocol::Request& request);
  SimTime now() const { return now_; }

 private:
  sim::protocol::Reply reply_to(const sim::protocol::Open& open);
  sim::protocol::Reply reply_to(const sim::protocol::Reset& reset);
  sim::protocol::Reply reply_to(const sim::protocol::Advance& advance);
  sim::protocol::Reply reply_to(const sim::protocol::CastRays& rays);
  sim::protocol::Reply reply_to(const sim::protocol::Render& view);
  std::vector<uav::Pose> poses() const;
  sim::protocol::State state(std::int64_t steps) const;

  sim::protocol::Open open_;
  SimTime now_{};
};

}  // namespace tether::system_test
