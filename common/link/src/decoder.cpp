#include "link_generated.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <tether/link/codec.h>

/// Frames to messages. FlatBuffers verifies the structure of a frame, `read` converts each table to
/// its message, and `validate` checks the values. Only then the message is returned.
namespace tether::link {
namespace {

/// Above anything that `validate` accepts.
constexpr flatbuffers::uoffset_t kMaxDepth = 8;
constexpr flatbuffers::uoffset_t kMaxTables = 4 * kMaxCatalogueEntries + 16;
/// Length, root offset, identifier, and the least root table.
constexpr std::size_t kMinFrameBytes = 16;

Failure protocol_failure(const std::string& what) {
  return {Failure::Kind::kProtocol, "bad message: " + what};
}

uav::Vec3 from_wire(const wire::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
uav::Quat from_wire(const wire::Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
uav::Pose from_wire(const wire::Pose& X) {
  return {from_wire(X.p()), from_wire(X.q())};
}

// --- stages -------------------------------------------------------------------------------------

std::vector<StageTime> read(
    const flatbuffers::Vector<flatbuffers::Offset<wire::StageTime>>* times) {
  std::vector<StageTime> out;
  if (times == nullptr) return out;
  for (const wire::StageTime* time : *times)
    out.push_back({time->stage()->str(), Duration(time->computing_ns())});
  return out;
}

template <class T>
std::vector<T> values_of(const flatbuffers::Vector<T>* vector) {
  if (vector == nullptr) return {};
  std::vector<T> values(vector->size());
  if (!values.empty()) std::memcpy(values.data(), vector->data(), values.size() * sizeof(T));
  return values;
}

std::vector<std::string> texts_of(
    const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* vector) {
  std::vector<std::string> texts;
  if (vector == nullptr) return texts;
  for (const flatbuffers::String* text : *vector) texts.push_back(text->str());
  return texts;
}

// --- catalogue ----------------------------------------------------------------------------------

uav::CameraProperties read(const wire::CameraProperties& c) {
  uav::CameraProperties out{{c.width_px(), c.height_px(), c.fx_px(), c.fy_px(), c.cx_px(),
                             c.cy_px(), c.k1(), c.k2(), c.k3(), c.p1(), c.p2()},
                            static_cast<uav::CameraKind>(c.kind()),
                            c.min_m(),
                            c.max_m()};
  out.models = texts_of(c.models());
  return out;
}

/// False: a kind that this version does not know.
bool read(const wire::Sensor& sensor, uav::SensorDescription& out) {
  out.name = sensor.name()->str();
  out.X_BS = from_wire(*sensor.x_bs());
  out.rate_hz = sensor.rate_hz();
  if (const auto* camera = sensor.properties_as_CameraProperties()) {
    out.properties = read(*camera);
  } else if (sensor.properties_as_ImuProperties()) {
    out.properties = uav::ImuProperties{};
  } else if (const auto* range = sensor.properties_as_RangeProperties()) {
    out.properties = uav::RangeProperties{range->min_m(), range->max_m()};
  } else {
    return false;
  }
  return true;
}

uav::Anchor read(const wire::Anchor& anchor) {
  return {anchor.name()->str(), static_cast<uav::AnchorShape>(anchor.shape()),
          from_wire(*anchor.size_m()), from_wire(*anchor.color_rgb())};
}

Result<Message> read(const wire::Welcome& welcome) {
  Welcome out;
  const wire::Catalogue& catalogue = *welcome.catalogue();
  out.catalogue.uav = catalogue.uav()->str();
  for (const wire::Sensor* sensor : *catalogue.sensors()) {
    if (!read(*sensor, out.catalogue.sensors.emplace_back())) {
      return protocol_failure("sensor of unknown kind");
    }
  }
  for (const wire::Anchor* anchor : *catalogue.anchors()) {
    out.catalogue.anchors.push_back(read(*anchor));
  }
  out.catalogue.battery_capacity_C = catalogue.battery_capacity_c();
  out.free_running = welcome.free_running();
  out.start = from_ns<ExecTime>(welcome.start_et_ns());
  out.computing = read(welcome.computing());
  out.peers = texts_of(welcome.peers());
  out.real_time_factor = welcome.real_time_factor();
  return Message(std::move(out));
}

// --- request ------------------------------------------------------------------------------------

Result<Message> read(const wire::Request& request) {
  Request out;
  out.sequence = request.sequence();
  out.issued_at = from_ns<ExecTime>(request.issued_at_et_ns());
  out.previous_round_trip = Duration(request.previous_round_trip_ns());
  out.stages = read(request.stages());
  if (const auto* sensor = request.body_as_ReadSensor()) {
    out.body = ReadSensor{sensor->sensor(), sensor->latest(), sensor->only_if_available()};
  } else if (const auto* set = request.body_as_SetVelocity()) {
    out.body = SetVelocity{{from_wire(*set->velocity_h_m_s()), set->yaw_rate_rad_s()}};
  } else if (const auto* sleep = request.body_as_Sleep()) {
    out.body = Sleep{from_ns<ExecTime>(sleep->until_et_ns()), sleep->is_relative()};
  } else if (const auto* finish = request.body_as_FinishMission()) {
    out.body = Finish{finish->reached_goal(), finish->outcome()->str(), finish->details()->str()};
  } else if (const auto* send = request.body_as_SendMessage()) {
    out.body =
        SendMessage{send->to() != nullptr ? send->to()->str() : "", values_of(send->bytes())};
  } else if (const auto* receive = request.body_as_ReceiveMessage()) {
    out.body = ReceiveMessage{Duration(receive->timeout_ns())};
  } else if (request.body_as_ReadBattery()) {
    out.body = ReadBattery{};
  } else {
    return protocol_failure("request of unknown kind");
  }
  return Message(std::move(out));
}

// --- reply --------------------------------------------------------------------------------------

uav::CameraSample read(const wire::CameraSample& s) {
  return {from_ns<SimTime>(s.sampled_at_st_ns()),
          s.index(),
          s.width_px(),
          s.height_px(),
          values_of(s.rgb()),
          values_of(s.depth_m()),
          values_of(s.labels())};
}
uav::ImuSample read(const wire::ImuSample& s) {
  return {from_ns<SimTime>(s.sampled_at_st_ns()), s.index(), from_wire(*s.angular_velocity_rad_s()),
          from_wire(*s.specific_force_m_s2()), from_wire(*s.q_ws())};
}
uav::RangeSample read(const wire::RangeSample& s) {
  return {from_ns<SimTime>(s.sampled_at_st_ns()), s.index(), s.range_m()};
}

Result<Message> read(const wire::Reply& reply) {
  Reply out;
  out.sequence = reply.sequence();
  out.resume_at = from_ns<ExecTime>(reply.resume_at_et_ns());
  out.computing = read(reply.computing());
  if (const auto* camera = reply.sample_as_CameraSample()) {
    out.sample = read(*camera);
  } else if (const auto* imu = reply.sample_as_ImuSample()) {
    out.sample = read(*imu);
  } else if (const auto* range = reply.sample_as_RangeSample()) {
    out.sample = read(*range);
  } else if (reply.sample_type() != wire::Sample::NONE) {
    return protocol_failure("sample of unknown kind");
  }
  if (const auto* message = reply.message())
    out.message = {message->from()->str(), from_ns<SimTime>(message->sent_at_st_ns()),
                   from_ns<SimTime>(message->arrived_at_st_ns()), values_of(message->bytes())};
  if (const auto* battery = reply.battery())
    out.battery = {from_ns<SimTime>(battery->sampled_at_st_ns()), battery->voltage_v(),
                   battery->current_a(), battery->charge()};
  return Message(std::move(out));
}

// --- the others ---------------------------------------------------------------------------------

Result<Message> read(const wire::Hello& hello) {
  std::vector<BuildPart> build;
  if (hello.build() != nullptr)
    for (const wire::BuildPart* part : *hello.build())
      build.push_back({part->name()->str(), part->value()->str()});
  return Message(Hello{hello.protocol_version(),
                       hello.sut()->str(),
                       hello.uav()->str(),
                       {static_cast<computer::ClockKind>(hello.clock()), hello.cpu_factor(),
                        Duration(hello.computing_ns())},
                       hello.token()->str(),
                       hello.concurrent(),
                       hello.build_id() != nullptr ? hello.build_id()->str() : "",
                       hello.process(),
                       std::move(build)});
}
Result<Message> read(const wire::Refusal& refusal) {
  return Message(Refusal{static_cast<Refusal::Reason>(refusal.reason()), refusal.message()->str()});
}
Result<Message> read(const wire::Progress& progress) {
  return Message(Progress{from_ns<ExecTime>(progress.reached_et_ns()), progress.stopped(),
                          progress.received_bytes(), progress.dues_heard()});
}
Result<Message> read(const wire::Due& due) {
  return Message(Due{due.sequence(), from_ns<ExecTime>(due.reply_at_et_ns())});
}
Result<Message> read(const wire::Annotation& annotation) {
  return Message(Annotation{from_ns<ExecTime>(annotation.at_et_ns()), annotation.topic()->str(),
                            annotation.json()->str()});
}

Result<Message> read(const wire::Envelope& envelope) {
  switch (envelope.content_type()) {
    case wire::Content::Hello:
      return read(*envelope.content_as_Hello());
    case wire::Content::Welcome:
      return read(*envelope.content_as_Welcome());
    case wire::Content::Refusal:
      return read(*envelope.content_as_Refusal());
    case wire::Content::Request:
      return read(*envelope.content_as_Request());
    case wire::Content::Reply:
      return read(*envelope.content_as_Reply());
    case wire::Content::Progress:
      return read(*envelope.content_as_Progress());
    case wire::Content::Annotation:
      return read(*envelope.content_as_Annotation());
    case wire::Content::Due:
      return read(*envelope.content_as_Due());
    case wire::Content::NONE:
      break;
  }
  return protocol_failure("message of unknown kind");
}

bool is_aligned(const std::uint8_t* p) {
  return reinterpret_cast<std::uintptr_t>(p) % 8 == 0;
}

}  // namespace

Result<Message> decode(std::span<const std::uint8_t> frame) {
  if (frame.size() < kMinFrameBytes) return protocol_failure("frame too short");
  // The fields are read in place, and must be aligned for their types.
  if (!is_aligned(frame.data())) {
    std::vector<std::uint64_t> aligned((frame.size() + 7) / 8);
    std::memcpy(aligned.data(), frame.data(), frame.size());
    return decode({reinterpret_cast<const std::uint8_t*>(aligned.data()), frame.size()});
  }
  flatbuffers::Verifier verifier(frame.data(), frame.size(), kMaxDepth, kMaxTables);
  if (!wire::VerifySizePrefixedEnvelopeBuffer(verifier)) {
    return protocol_failure("not a Tether message, or corrupt");
  }
  auto message = read(*wire::GetSizePrefixedEnvelope(frame.data()));
  if (!message) return message;
  if (const Status valid = validate(*message); !valid) {
    return protocol_failure(valid.failure().message);
  }
  return message;
}

Result<std::uint32_t> decode_frame_length(std::span<const std::uint8_t, kFrameHeaderBytes> header,
                                          std::uint32_t limit) {
  const std::uint32_t length = header[0] | std::uint32_t{header[1]} << 8 |
                               std::uint32_t{header[2]} << 16 | std::uint32_t{header[3]} << 24;
  if (length == 0) return protocol_failure("frame of length 0");
  if (length > limit) {
    return protocol_failure("frame of " + std::to_string(length) + " bytes announced, at most " +
                            std::to_string(limit) + " allowed (is the peer a Tether program?)");
  }
  return length;
}

}  // namespace tether::link
