#include "link_generated.h"

#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include <tether/link/codec.h>

/// Messages to frames. Each `write` adds a table to the builder and returns its offset, innermost
/// first. An image's pixels are not copied into the builder: only their place is kept (ImageSlot).
namespace tether::link {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

wire::Vec3 to_wire(const uav::Vec3& v) {
  return {v.x, v.y, v.z};
}
wire::Quat to_wire(const uav::Quat& q) {
  return {q.w, q.x, q.y, q.z};
}
wire::Pose to_wire(const uav::Pose& X) {
  return {to_wire(X.p), to_wire(X.q)};
}

/// A union member: its type and where it was written.
template <class Kind>
struct Member {
  Kind kind;
  Offset<void> at;
};

// --- Welcome ------------------------------------------------------------------------------------

using Properties = Member<wire::SensorProperties>;

Properties write(FlatBufferBuilder& b, const uav::CameraProperties& camera) {
  const uav::CameraModel& m = camera.model;
  const auto models = camera.models.empty() ? 0 : b.CreateVectorOfStrings(camera.models);
  return {wire::SensorProperties::CameraProperties,
          wire::CreateCameraProperties(b, m.width_px, m.height_px, m.fx_px, m.fy_px, m.cx_px,
                                       m.cy_px, m.k1, m.k2, m.k3, m.p1, m.p2,
                                       static_cast<wire::CameraKind>(camera.kind), camera.min_m,
                                       camera.max_m, models)
              .Union()};
}
Properties write(FlatBufferBuilder& b, const uav::ImuProperties&) {
  return {wire::SensorProperties::ImuProperties, wire::CreateImuProperties(b).Union()};
}
Properties write(FlatBufferBuilder& b, const uav::RangeProperties& range) {
  return {wire::SensorProperties::RangeProperties,
          wire::CreateRangeProperties(b, range.min_m, range.max_m).Union()};
}

Offset<wire::Sensor> write(FlatBufferBuilder& b, const uav::SensorDescription& sensor) {
  const auto name = b.CreateString(sensor.name);
  const Properties properties =
      std::visit([&b](const auto& p) { return write(b, p); }, sensor.properties);
  const wire::Pose X_BS = to_wire(sensor.X_BS);
  return wire::CreateSensor(b, name, &X_BS, sensor.rate_hz, properties.kind, properties.at);
}

Offset<wire::Anchor> write(FlatBufferBuilder& b, const uav::Anchor& anchor) {
  const auto name = b.CreateString(anchor.name);
  const wire::Vec3 size_m = to_wire(anchor.size_m);
  const wire::Vec3 color_rgb = to_wire(anchor.color_rgb);
  return wire::CreateAnchor(b, name, static_cast<wire::AnchorShape>(anchor.shape), &size_m,
                            &color_rgb);
}

Offset<wire::Catalogue> write(FlatBufferBuilder& b, const uav::Catalogue& catalogue) {
  std::vector<Offset<wire::Sensor>> sensors;
  for (const auto& sensor : catalogue.sensors) sensors.push_back(write(b, sensor));
  std::vector<Offset<wire::Anchor>> anchors;
  for (const auto& anchor : catalogue.anchors) anchors.push_back(write(b, anchor));
  const auto uav = b.CreateString(catalogue.uav);
  const auto sensor_list = b.CreateVector(sensors);
  return wire::CreateCatalogue(b, uav, sensor_list, b.CreateVector(anchors),
                               catalogue.battery_capacity_C);
}

// --- stages -------------------------------------------------------------------------------------

/// 0: none, which takes no room.
using StageTimes = Offset<flatbuffers::Vector<Offset<wire::StageTime>>>;

StageTimes write(FlatBufferBuilder& b, const std::vector<StageTime>& times) {
  if (times.empty()) return 0;
  std::array<Offset<wire::StageTime>, kMaxStages> written;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto stage = b.CreateString(times[i].stage);
    written[i] = wire::CreateStageTime(b, stage, times[i].computing.count());
  }
  return b.CreateVector(written.data(), times.size());
}

// --- Request ------------------------------------------------------------------------------------

using Body = Member<wire::RequestBody>;

Body write(FlatBufferBuilder& b, const ReadSensor& read) {
  return {wire::RequestBody::ReadSensor,
          wire::CreateReadSensor(b, read.sensor, read.latest, read.only_if_available).Union()};
}
Body write(FlatBufferBuilder& b, const SetVelocity& set) {
  const wire::Vec3 velocity = to_wire(set.command.velocity_H_m_s);
  return {wire::RequestBody::SetVelocity,
          wire::CreateSetVelocity(b, &velocity, set.command.yaw_rate_rad_s).Union()};
}
Body write(FlatBufferBuilder& b, const Sleep& sleep) {
  return {wire::RequestBody::Sleep,
          wire::CreateSleep(b, to_ns(sleep.until), sleep.is_relative).Union()};
}
Body write(FlatBufferBuilder& b, const Finish& finish) {
  const auto outcome = b.CreateString(finish.outcome);
  const auto details = b.CreateString(finish.details);
  return {wire::RequestBody::FinishMission,
          wire::CreateFinishMission(b, finish.reached_goal, outcome, details).Union()};
}
Body write(FlatBufferBuilder& b, const SendMessage& send) {
  const auto bytes = b.CreateVector(send.bytes);
  const auto to = b.CreateString(send.to);
  return {wire::RequestBody::SendMessage, wire::CreateSendMessage(b, to, bytes).Union()};
}
Body write(FlatBufferBuilder& b, const ReceiveMessage& receive) {
  return {wire::RequestBody::ReceiveMessage,
          wire::CreateReceiveMessage(b, receive.timeout.count()).Union()};
}
Body write(FlatBufferBuilder& b, const ReadBattery&) {
  return {wire::RequestBody::ReadBattery, wire::CreateReadBattery(b).Union()};
}

// --- Reply --------------------------------------------------------------------------------------

/// Where an image belongs in the finished buffer.
struct ImageSlot {
  std::span<const std::uint8_t> pixels;
  std::size_t end_distance = 0;  ///< from the vector's length field to the end of the buffer
};

using SampleMember = Member<wire::Sample>;

/// Leaves room for the pixels without touching it. Being written first, they lie at the end of the
/// buffer (it grows downwards), so that a frame is one piece before them and, at most, padding
/// after.
SampleMember write(FlatBufferBuilder& b, const uav::CameraSample& sample, ImageSlot& slot) {
  std::uint8_t* room = nullptr;
  const Offset<flatbuffers::Vector<std::uint8_t>> rgb(
      b.CreateUninitializedVector<std::uint8_t>(sample.rgb.size(), &room));
  slot = {sample.rgb, rgb.o};
  const auto depth_m = sample.depth_m.empty() ? 0 : b.CreateVector(sample.depth_m);
  const auto labels = sample.labels.empty() ? 0 : b.CreateVector(sample.labels);
  return {wire::Sample::CameraSample,
          wire::CreateCameraSample(b, to_ns(sample.sampled_at), sample.index, sample.width_px,
                                   sample.height_px, rgb, depth_m, labels)
              .Union()};
}
SampleMember write(FlatBufferBuilder& b, const uav::ImuSample& sample, ImageSlot&) {
  const wire::Vec3 angular_velocity = to_wire(sample.angular_velocity_rad_s);
  const wire::Vec3 specific_force = to_wire(sample.specific_force_m_s2);
  const wire::Quat q_WS = to_wire(sample.q_WS);
  return {wire::Sample::ImuSample, wire::CreateImuSample(b, to_ns(sample.sampled_at), sample.index,
                                                         &angular_velocity, &specific_force, &q_WS)
                                       .Union()};
}
SampleMember write(FlatBufferBuilder& b, const uav::RangeSample& sample, ImageSlot&) {
  return {
      wire::Sample::RangeSample,
      wire::CreateRangeSample(b, to_ns(sample.sampled_at), sample.index, sample.range_m).Union()};
}

// --- Envelope -----------------------------------------------------------------------------------

using Content = Member<wire::Content>;

Content write(FlatBufferBuilder& b, const Hello& hello, ImageSlot&) {
  const auto sut = b.CreateString(hello.sut);
  const auto uav = b.CreateString(hello.uav);
  const auto token = b.CreateString(hello.token);
  const auto build_id = hello.build_id.empty() ? 0 : b.CreateString(hello.build_id);
  std::vector<Offset<wire::BuildPart>> parts;
  for (const BuildPart& part : hello.build) {
    const auto name = b.CreateString(part.name);
    parts.push_back(wire::CreateBuildPart(b, name, b.CreateString(part.value)));
  }
  const auto build = parts.empty() ? 0 : b.CreateVector(parts);
  return {wire::Content::Hello,
          wire::CreateHello(b, hello.protocol_version, sut, uav,
                            static_cast<wire::ClockKind>(hello.clock.kind), hello.clock.factor,
                            token, hello.concurrent, hello.clock.computing.count(), build_id,
                            hello.process, build)
              .Union()};
}
Content write(FlatBufferBuilder& b, const Welcome& welcome, ImageSlot&) {
  const auto catalogue = write(b, welcome.catalogue);
  const StageTimes computing = write(b, welcome.computing);
  const auto peers = welcome.peers.empty() ? 0 : b.CreateVectorOfStrings(welcome.peers);
  return {wire::Content::Welcome,
          wire::CreateWelcome(b, catalogue, welcome.free_running, to_ns(welcome.start), computing,
                              peers, welcome.real_time_factor)
              .Union()};
}
Content write(FlatBufferBuilder& b, const Refusal& refusal, ImageSlot&) {
  const auto message = b.CreateString(refusal.message);
  return {
      wire::Content::Refusal,
      wire::CreateRefusal(b, static_cast<wire::RefusalReason>(refusal.reason), message).Union()};
}
Content write(FlatBufferBuilder& b, const Request& request, ImageSlot&) {
  const Body body = std::visit([&b](const auto& r) { return write(b, r); }, request.body);
  const StageTimes stages = write(b, request.stages);
  return {wire::Content::Request,
          wire::CreateRequest(b, request.sequence, to_ns(request.issued_at),
                              to_ns(request.previous_round_trip), body.kind, body.at, stages)
              .Union()};
}
Content write(FlatBufferBuilder& b, const Reply& reply, ImageSlot& slot) {
  SampleMember sample{wire::Sample::NONE, 0};
  if (reply.sample) {
    sample = std::visit([&](const auto& s) { return write(b, s, slot); }, *reply.sample);
  }
  const StageTimes computing = write(b, reply.computing);
  Offset<wire::RadioMessage> message;
  if (reply.message) {
    const auto bytes = b.CreateVector(reply.message->bytes);
    const auto from = b.CreateString(reply.message->from);
    message = wire::CreateRadioMessage(b, from, to_ns(reply.message->sent_at),
                                       to_ns(reply.message->arrived_at), bytes);
  }
  Offset<wire::BatterySample> battery;
  if (reply.battery) {
    battery =
        wire::CreateBatterySample(b, to_ns(reply.battery->sampled_at), reply.battery->voltage_V,
                                  reply.battery->current_A, reply.battery->charge);
  }
  return {wire::Content::Reply,
          wire::CreateReply(b, reply.sequence, to_ns(reply.resume_at), sample.kind, sample.at,
                            computing, message, battery)
              .Union()};
}
Content write(FlatBufferBuilder& b, const Progress& progress, ImageSlot&) {
  return {wire::Content::Progress,
          wire::CreateProgress(b, to_ns(progress.reached), progress.stopped,
                               progress.received_bytes, progress.dues_heard)
              .Union()};
}
Content write(FlatBufferBuilder& b, const Due& due, ImageSlot&) {
  return {wire::Content::Due, wire::CreateDue(b, due.sequence, to_ns(due.reply_at)).Union()};
}
Content write(FlatBufferBuilder& b, const Annotation& annotation, ImageSlot&) {
  const auto topic = b.CreateString(annotation.topic);
  const auto json = b.CreateString(annotation.json);
  return {wire::Content::Annotation,
          wire::CreateAnnotation(b, to_ns(annotation.at), topic, json).Union()};
}

}  // namespace

struct Encoder::Impl {
  FlatBufferBuilder builder;
  ImageSlot slot;

  void build(const Message& message) {
    builder.Clear();
    slot = {};
    const Content content =
        std::visit([this](const auto& m) { return write(builder, m, slot); }, message);
    const auto envelope = wire::CreateEnvelope(builder, content.kind, content.at);
    wire::FinishSizePrefixedEnvelopeBuffer(builder, envelope);
  }

  std::span<std::uint8_t> frame() { return {builder.GetBufferPointer(), builder.GetSize()}; }
  std::size_t image_begin() {
    return frame().size() - slot.end_distance + sizeof(flatbuffers::uoffset_t);
  }
};

Encoder::Encoder() : impl_(std::make_unique<Impl>()) {}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

std::span<const std::uint8_t> Encoder::encode(const Message& message) {
  impl_->build(message);
  const auto frame = impl_->frame();
  const auto pixels = impl_->slot.pixels;
  if (!pixels.empty()) std::memcpy(&frame[impl_->image_begin()], pixels.data(), pixels.size());
  return frame;
}

FramePieces Encoder::encode_pieces(const Message& message) {
  impl_->build(message);
  const auto frame = impl_->frame();
  const auto pixels = impl_->slot.pixels;
  if (pixels.empty()) return {frame, {}, {}};
  const std::size_t begin = impl_->image_begin();
  return {frame.first(begin), pixels, frame.subspan(begin + pixels.size())};
}

}  // namespace tether::link
