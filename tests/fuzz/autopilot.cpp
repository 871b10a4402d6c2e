#include "fuzz_target.h"

#include <bit>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

/// The built-in flight controller and its signed link, and a companion that sends anything. Input:
/// choices, then what the companion sends between two steps. Whatever that is, what is flown can be
/// flown, what is sent is MAVLink, the record has it as JSON on one line, and an honest companion
/// is answered.
namespace tether::fuzz {
namespace {

using autopilot::Bytes;
using mavlink::Message;

const std::string kKey(32, 'k');
constexpr std::uint64_t kLater = std::uint64_t{1} << 46;

/// A message of the table whose fields are often what the controller expects.
Message message_of(Choices& choices) {
  const auto types = mavlink::message_types();
  Message message(types[choices.below(types.size())]);
  for (const mavlink::Field& field : message.type().fields) {
    const std::size_t i = choices.below(field.count);
    if (field.name.starts_with("target_"))
      message.set(field.name, choices.below(4) == 0 ? choices.byte() : 1);
    else if (choices.coin())
      message.set(field.name, choices.number(), i);
    else if (choices.coin())
      message.set(field.name, std::bit_cast<double>(choices.word()), i);
  }
  return message;
}

class Companion {
 public:
  explicit Companion(bool is_signed) : is_signed_(is_signed) {}

  Bytes frame(const Message& message, mavlink::Address from, bool is_honest) {
    return mavlink::encode(message, from, 0, is_signed_ && is_honest ? &signer_ : nullptr);
  }
  Bytes datagram(Choices& choices) {
    const std::size_t kind = choices.below(4);
    if (kind == 0) {
      const auto bytes = choices.take(choices.byte());
      return {bytes.begin(), bytes.end()};
    }
    Bytes bytes =
        frame(message_of(choices), {choices.byte(), choices.byte()}, choices.below(8) > 0);
    if (kind == 1) bytes[choices.byte() % bytes.size()] ^= choices.byte();
    return bytes;
  }

 private:
  bool is_signed_;
  mavlink::Signer signer_{*mavlink::key_of_file(kKey), 1, kLater};
};

/// It is where it shall be, but not below the ground.
void follow(const uav::Setpoint& setpoint, uav::BodyState& body) {
  constexpr double kStep_s = 0.004;
  if (setpoint.has(uav::kPosition)) body.p_WB = setpoint.p_WB_m;
  body.v_WB = setpoint.has(uav::kVelocity) ? setpoint.velocity_m_s : uav::Vec3{};
  body.p_WB = body.p_WB + kStep_s * body.v_WB;
  if (body.p_WB.z <= 0.0) body.p_WB.z = body.v_WB.z = 0.0;
}

void fly(Choices choices) {
  const bool is_signed = choices.coin();
  const uav::FlightLimits limits = flight_limits(uav::hummingbird());
  const bool in_air = choices.coin();
  auto controller =
      autopilot::make_built_in({.limits = limits, .hover_thrust_N = 5.0, .starts_in_air = in_air});
  if (is_signed) controller = autopilot::with_signing(std::move(controller), kKey);
  Companion companion(is_signed);
  autopilot::Sensed sensed{.at = {}, .truth = {}};
  const auto step = [&](const std::vector<Bytes>& received) {
    autopilot::Actions actions = controller->step(sensed, received);
    sensed.at += autopilot::kBuiltInPeriod;
    require(actions.setpoint.has_value(), "nothing to fly");
    require(complaint_about(*actions.setpoint, limits).empty(),
            "what cannot be flown: " + complaint_about(*actions.setpoint, limits));
    follow(*actions.setpoint, sensed.truth);
    return actions.sent;
  };
  for (int i = 0; !in_air && i < 300; ++i) step({});  // it boots
  std::uint32_t number = 0;
  while (!choices.empty()) {
    std::vector<Bytes> received;
    for (std::size_t i = choices.below(4); i > 0; --i) {
      received.push_back(companion.datagram(choices));
      for (const autopilot::Decoded& decoded : autopilot::decode(received.back()))
        require_one_line(decoded.fields_json);
    }
    received.push_back(companion.frame(Message("PING").set("seq", ++number), {7, 7}, true));
    bool is_answered = false;
    for (const Bytes& sent : step(received)) {
      const auto frames = mavlink::Decoder().push_datagram(sent);
      require(frames.size() == 1, "what is sent is no frame");
      const Message& message = frames[0].message;
      is_answered |= message.is("PING") && message.integer("seq") == number &&
                     message.integer("target_system") == 7;
    }
    require(is_answered, "an honest companion is not answered");
    for (std::size_t i = choices.byte() / 8; i > 0; --i) step({});
  }
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tether::fuzz::fly(tether::fuzz::Choices({data, size}));
  return 0;
}
