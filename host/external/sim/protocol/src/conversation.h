#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim::protocol {

/// The state of one connection, which decides the messages that may follow: their order, sizes and
/// times. Each end has one, and checks what it receives. Messages must have passed `validate`.
class Conversation {
 public:
  /// At the simulator's end. Fail with kProtocol and the field.
  Status check(const Request& request) const;
  /// At the host's end.
  Status check(const Reply& reply) const;

  /// After a request was sent, or received and checked.
  void ask(const Request& request);

 private:
  template <class Member>
  const Member* asked() const {
    return asked_ ? std::get_if<Member>(&*asked_) : nullptr;
  }
  /// What the reply to the last request must match.
  struct ForState {
    SimTime from;
    SimTime to;
    std::size_t past;
  };
  struct ForRays {
    std::size_t count;
  };
  struct ForPicture {
    std::int32_t width_px, height_px;
    bool with_depth;
  };

  void note(const Open& open);
  void note(const Reset& reset);
  void note(const Advance& advance);
  void note(const CastRays& cast);
  void note(const Render& render);

  std::string complaint(const Open& open) const;
  std::string complaint(const Reset&) const { return {}; }
  std::string complaint(const Advance& advance) const;
  std::string complaint(const CastRays& cast) const;
  std::string complaint(const Render& render) const;

  std::string complaint(const Opened& opened) const;
  std::string complaint(const State& state) const;
  std::string complaint(const Distances& distances) const;
  std::string complaint(const Picture& picture) const;
  std::string complaint(const Failed&) const { return {}; }
  std::string complaint_of_state(const State& state, const ForState& asked) const;

  bool is_open_ = false;
  bool opening_ = false;  ///< the last request was Open
  Duration step_{1};
  std::vector<uav::FlightLimits> uavs_;
  std::size_t bodies_ = 0;
  std::size_t past_steps_ = 0;
  std::int32_t max_width_px_ = 0;
  std::int32_t max_height_px_ = 0;
  SimTime now_;
  std::optional<std::variant<ForState, ForRays, ForPicture>> asked_;
};

}  // namespace tether::sim::protocol
