// Decodes frames: verifies the FlatBuffer, converts the tables of the schema into the structs of
// messages.h, and validates the result. One `read` or `from_wire` for each table and struct.

#include "wire_types.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

/// Above anything that `validate` accepts.
constexpr flatbuffers::uoffset_t kMaxDepth = 8;
constexpr flatbuffers::uoffset_t kMaxTables = 3 * kMaxBodies + kMaxMaterials + kMaxTouches + 16;
/// Length, root offset, identifier, and the least root table.
constexpr std::size_t kMinFrameBytes = 16;

Failure protocol_failure(const std::string& what) {
  return {Failure::Kind::kProtocol, "bad message: " + what};
}

/// `validate` refuses indices that are too large, and negative ones except -1.
std::optional<std::uint32_t> index_from_wire(std::int32_t index) {
  if (index == -1) return std::nullopt;
  return static_cast<std::uint32_t>(index);
}

uav::Rotor from_wire(const wire::Rotor& rotor) {
  return {protocol::from_wire(rotor.p_br()), rotor.direction()};
}
Command from_wire(const wire::Command& c) {
  return {c.uav(), {protocol::from_wire(c.velocity_h_m_s()), c.yaw_rate_rad_s()}};
}
uav::BodyState from_wire(const wire::BodyState& s) {
  return {protocol::from_wire(s.p_wb()), protocol::from_wire(s.q_wb()),
          protocol::from_wire(s.v_wb()), protocol::from_wire(s.w_wb_b())};
}
Motion from_wire(const wire::Motion& m) {
  return {protocol::from_wire(m.a_wb_w()), protocol::from_wire(m.alpha_wb_b())};
}
using protocol::from_wire;

/// The verifier does not check the alignment of a vector's elements: they are copied, not read in
/// place.
template <class T, class Wire>
std::vector<T> list(const flatbuffers::Vector<const Wire*>& values) {
  std::vector<T> out;
  out.reserve(values.size());
  Wire value;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::memcpy(&value, values.Data() + i * sizeof value, sizeof value);
    out.push_back(from_wire(value));
  }
  return out;
}

// --- Open ---------------------------------------------------------------------------------------

uav::MultirotorParameters from_wire(const wire::Airframe& a) {
  uav::MultirotorParameters out;
  out.mass_kg = a.mass_kg();
  out.inertia_kg_m2 = from_wire(*a.inertia_kg_m2());
  out.rotors = list<uav::Rotor>(*a.rotors());
  out.thrust_coefficient = a.thrust_coefficient();
  out.moment_coefficient_m = a.moment_coefficient_m();
  out.drag_coefficient = a.drag_coefficient();
  out.linear_drag_N_s_m = a.linear_drag_n_s_m();
  out.max_rotor_speed_rad_s = a.max_rotor_speed_rad_s();
  out.time_constant_up_s = a.time_constant_up_s();
  out.time_constant_down_s = a.time_constant_down_s();
  out.max_tilt_rad = a.max_tilt_rad();
  out.max_horizontal_speed_m_s = a.max_horizontal_speed_m_s();
  out.max_vertical_speed_m_s = a.max_vertical_speed_m_s();
  out.max_yaw_rate_rad_s = a.max_yaw_rate_rad_s();
  out.max_acceleration_m_s2 = a.max_acceleration_m_s2();
  out.max_yaw_acceleration_rad_s2 = a.max_yaw_acceleration_rad_s2();
  return out;
}

VisualMaterial from_wire(const wire::Look& look) {
  VisualMaterial out;
  out.model = look.model()->str();
  out.link = look.link()->str();
  out.visual = look.visual()->str();
  out.ambient_rgb = from_wire(*look.ambient_rgb());
  out.diffuse_rgb = from_wire(*look.diffuse_rgb());
  out.specular_rgb = from_wire(*look.specular_rgb());
  out.emissive_rgb = from_wire(*look.emissive_rgb());
  out.texture = look.texture()->str();
  out.texture_repeat_x = look.texture_repeat_x();
  out.texture_repeat_y = look.texture_repeat_y();
  out.alpha = look.alpha();
  return out;
}

Open read(const wire::Open& open) {
  Open out;
  out.version = open.version();
  out.world_name = open.world_name()->str();
  out.world_file = open.world_file()->str();
  out.gravity_m_s2 = open.gravity_m_s2();
  out.step = Duration(open.step_ns());
  for (const wire::Uav* uav : *open.uavs()) {
    out.uavs.push_back({uav->name()->str(), uav->sdf()->str(), from_wire(*uav->x_wb()),
                        from_wire(*uav->airframe())});
  }
  for (const wire::BodyName* body : *open.bodies()) {
    out.bodies.push_back({body->model()->str(), body->link()->str()});
  }
  out.past_steps = open.past_steps();
  out.max_width_px = open.max_width_px();
  out.max_height_px = open.max_height_px();
  for (const wire::Look* look : *open.looks()) out.materials.push_back(from_wire(*look));
  return out;
}

// --- the other requests -------------------------------------------------------------------------

Reset read(const wire::Reset& reset) {
  return {reset.seed()};
}
Advance read(const wire::Advance& advance) {
  return {from_ns<SimTime>(advance.to_st_ns()), list<Command>(*advance.commands())};
}
CastRays read(const wire::CastRays& cast) {
  return {list<uav::Pose>(*cast.x_wb()), index_from_wire(cast.carrier()), from_wire(*cast.x_ws()),
          list<uav::Vec3>(*cast.rays_s()), cast.max_m()};
}
Render read(const wire::Render& render) {
  Render out;
  out.camera.width_px = render.width_px();
  out.camera.height_px = render.height_px();
  out.camera.fx_px = render.focal_px();
  out.camera.fy_px = render.focal_px();
  out.camera.cx_px = render.cx_px();
  out.camera.cy_px = render.cy_px();
  out.near_m = render.near_m();
  out.far_m = render.far_m();
  out.X_WS = from_wire(*render.x_ws());
  out.X_WB = list<uav::Pose>(*render.x_wb());
  out.hidden = index_from_wire(render.hidden());
  out.with_depth = render.with_depth();
  return out;
}

// --- replies ------------------------------------------------------------------------------------

State read(const wire::State& state) {
  State out{from_ns<SimTime>(state.now_st_ns()), list<uav::BodyState>(*state.bodies()),
            list<Motion>(*state.motions()), list<uav::Pose>(*state.past())};
  if (state.touches() == nullptr) return out;
  for (const wire::Touch* touch : *state.touches()) {
    out.touches.push_back({from_ns<SimTime>(touch->at_st_ns()), touch->uav(), touch->with()->str(),
                           touch->shape(), touch->speed_m_s()});
  }
  return out;
}
Opened read(const wire::Opened& opened) {
  return {opened.description()->str(), read(*opened.state()), opened.reports_contacts()};
}
Distances read(const wire::Distances& distances) {
  Distances out;
  out.distance_m.resize(distances.distance_m()->size());
  if (!out.distance_m.empty()) {
    std::memcpy(out.distance_m.data(), distances.distance_m()->Data(),
                out.distance_m.size() * sizeof(double));
  }
  return out;
}
Picture read(const wire::Picture& picture) {
  const std::uint8_t* const rgb = picture.rgb()->data();
  return {picture.width_px(),
          picture.height_px(),
          {rgb, rgb + picture.rgb()->size()},
          picture.nearest_depth_m(),
          picture.renderer()->str()};
}
Failed read(const wire::Failed& failed) {
  return {failed.message()->str()};
}

// --- Envelope -----------------------------------------------------------------------------------

/// The content, which must be one of these tables.
template <class Message, class... Tables>
Result<Message> read_one_of(const wire::Envelope& envelope) {
  std::optional<Message> message;
  const auto take = [&message](const auto* table) {
    if (table != nullptr) message = read(*table);
  };
  (take(envelope.content_as<Tables>()), ...);
  if (!message) return protocol_failure("not a message of this direction and version");
  return std::move(*message);
}

bool is_aligned(const std::uint8_t* p) {
  return reinterpret_cast<std::uintptr_t>(p) % 8 == 0;
}

template <class Message, class Read>
Result<Message> decode(std::span<const std::uint8_t> frame, Read read_envelope) {
  if (frame.size() < kMinFrameBytes) return protocol_failure("frame too short");
  // The fields are read in place, so that they must lie where their types may.
  if (!is_aligned(frame.data())) {
    std::vector<std::uint64_t> aligned((frame.size() + 7) / 8);
    std::memcpy(aligned.data(), frame.data(), frame.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(aligned.data());
    return decode<Message>({data, frame.size()}, read_envelope);
  }
  flatbuffers::Verifier verifier(frame.data(), frame.size(), kMaxDepth, kMaxTables);
  if (!wire::VerifySizePrefixedEnvelopeBuffer(verifier)) {
    return protocol_failure("not a message of the simulator protocol, or corrupt");
  }
  Result<Message> message = read_envelope(*wire::GetSizePrefixedEnvelope(frame.data()));
  if (!message) return message;
  if (const Status valid = validate(*message); !valid) {
    return protocol_failure(valid.failure().message);
  }
  return message;
}

}  // namespace

Result<Request> decode_request(std::span<const std::uint8_t> frame) {
  return decode<Request>(
      frame,
      read_one_of<Request, wire::Open, wire::Reset, wire::Advance, wire::CastRays, wire::Render>);
}

Result<Reply> decode_reply(std::span<const std::uint8_t> frame) {
  return decode<Reply>(
      frame,
      read_one_of<Reply, wire::Opened, wire::State, wire::Distances, wire::Picture, wire::Failed>);
}

}  // namespace tether::sim::protocol
