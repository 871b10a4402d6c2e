// Encodes messages as FlatBuffers: the reverse of decoder.cpp, one `write` or `to_wire` for each
// table and struct. A picture's pixels are left out of the buffer and sent as a separate piece.

#include "wire_types.h"

#include <optional>
#include <utility>
#include <vector>

#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using flatbuffers::Vector;

std::int32_t index_or_none(const std::optional<std::uint32_t>& index) {
  return index ? static_cast<std::int32_t>(*index) : -1;
}

wire::Rotor to_wire(const uav::Rotor& rotor) {
  return {protocol::to_wire(rotor.p_BR), rotor.direction};
}
wire::Command to_wire(const Command& c) {
  return {protocol::to_wire(c.command.velocity_H_m_s), c.command.yaw_rate_rad_s, c.uav};
}
wire::BodyState to_wire(const uav::BodyState& s) {
  return {protocol::to_wire(s.p_WB), protocol::to_wire(s.q_WB), protocol::to_wire(s.v_WB),
          protocol::to_wire(s.w_WB_B)};
}
wire::Motion to_wire(const Motion& m) {
  return {protocol::to_wire(m.a_WB_W), protocol::to_wire(m.alpha_WB_B)};
}
using protocol::to_wire;

/// A vector of structs, converted in place.
template <class Wire, class T>
Offset<Vector<const Wire*>> structs(FlatBufferBuilder& b, const std::vector<T>& values) {
  Wire* room = nullptr;
  const auto at = b.CreateUninitializedVectorOfStructs<Wire>(values.size(), &room);
  for (const T& value : values) *room++ = to_wire(value);
  return Offset<Vector<const Wire*>>(at);
}

template <class Wire, class T, class Write>
Offset<Vector<Offset<Wire>>> tables(FlatBufferBuilder& b, const std::vector<T>& values,
                                    Write write) {
  std::vector<Offset<Wire>> offsets;
  for (const T& value : values) offsets.push_back(write(b, value));
  return b.CreateVector(offsets);
}

/// A union member: its type and where it was written.
struct Content {
  wire::Content kind;
  Offset<void> at;

  template <class Table>
  Content(Offset<Table> table)  // NOLINT: a table is a content
      : kind(wire::ContentTraits<Table>::enum_value), at(table.Union()) {}
};

/// Where a picture belongs in the finished buffer.
struct PictureSlot {
  std::span<const std::uint8_t> pixels;
  std::size_t end_distance = 0;  ///< from the vector's length field to the end of the buffer
};

// --- Open ---------------------------------------------------------------------------------------

Offset<wire::Airframe> write(FlatBufferBuilder& b, const uav::MultirotorParameters& p) {
  const auto rotors = structs<wire::Rotor>(b, p.rotors);
  const wire::Vec3 inertia_kg_m2 = to_wire(p.inertia_kg_m2);
  return wire::CreateAirframe(
      b, p.mass_kg, &inertia_kg_m2, rotors, p.thrust_coefficient, p.moment_coefficient_m,
      p.drag_coefficient, p.linear_drag_N_s_m, p.max_rotor_speed_rad_s, p.time_constant_up_s,
      p.time_constant_down_s, p.max_tilt_rad, p.max_horizontal_speed_m_s, p.max_vertical_speed_m_s,
      p.max_yaw_rate_rad_s, p.max_acceleration_m_s2, p.max_yaw_acceleration_rad_s2);
}

Offset<wire::Uav> write(FlatBufferBuilder& b, const UavDescription& uav) {
  const auto name = b.CreateString(uav.name);
  const auto sdf = b.CreateString(uav.sdf);
  const auto airframe = write(b, uav.airframe);
  const wire::Pose X_WB = to_wire(uav.X_WB);
  return wire::CreateUav(b, name, sdf, &X_WB, airframe);
}

Offset<wire::BodyName> write(FlatBufferBuilder& b, const BodyName& body) {
  const auto model = b.CreateString(body.model);
  return wire::CreateBodyName(b, model, b.CreateString(body.link));
}

Offset<wire::Look> write(FlatBufferBuilder& b, const VisualMaterial& look) {
  const auto model = b.CreateString(look.model);
  const auto link = b.CreateString(look.link);
  const auto visual = b.CreateString(look.visual);
  const auto texture = b.CreateString(look.texture);
  const wire::Vec3 ambient = to_wire(look.ambient_rgb);
  const wire::Vec3 diffuse = to_wire(look.diffuse_rgb);
  const wire::Vec3 specular = to_wire(look.specular_rgb);
  const wire::Vec3 emissive = to_wire(look.emissive_rgb);
  return wire::CreateLook(b, model, link, visual, &ambient, &diffuse, &specular, &emissive, texture,
                          look.texture_repeat_x, look.texture_repeat_y, look.alpha);
}

Content write(FlatBufferBuilder& b, const Open& open, PictureSlot&) {
  constexpr auto kWrite = [](FlatBufferBuilder& to, const auto& value) { return write(to, value); };
  const auto name = b.CreateString(open.world_name);
  const auto file = b.CreateString(open.world_file);
  const auto uavs = tables<wire::Uav>(b, open.uavs, kWrite);
  const auto bodies = tables<wire::BodyName>(b, open.bodies, kWrite);
  const auto looks = tables<wire::Look>(b, open.materials, kWrite);
  return wire::CreateOpen(b, open.version, name, file, open.gravity_m_s2, open.step.count(), uavs,
                          bodies, open.past_steps, open.max_width_px, open.max_height_px, looks);
}

// --- the other requests -------------------------------------------------------------------------

Content write(FlatBufferBuilder& b, const Reset& reset, PictureSlot&) {
  return wire::CreateReset(b, reset.seed);
}
Content write(FlatBufferBuilder& b, const Advance& advance, PictureSlot&) {
  const auto commands = structs<wire::Command>(b, advance.commands);
  return wire::CreateAdvance(b, to_ns(advance.to), commands);
}
Content write(FlatBufferBuilder& b, const CastRays& cast, PictureSlot&) {
  const auto X_WB = structs<wire::Pose>(b, cast.X_WB);
  const auto rays_S = structs<wire::Vec3>(b, cast.rays_S);
  const wire::Pose X_WS = to_wire(cast.X_WS);
  return wire::CreateCastRays(b, X_WB, index_or_none(cast.carrier), &X_WS, rays_S, cast.max_m);
}
Content write(FlatBufferBuilder& b, const Render& render, PictureSlot&) {
  const auto X_WB = structs<wire::Pose>(b, render.X_WB);
  const wire::Pose X_WS = to_wire(render.X_WS);
  const uav::CameraModel& c = render.camera;
  return wire::CreateRender(b, c.width_px, c.height_px, c.fx_px, c.cx_px, c.cy_px, render.near_m,
                            render.far_m, &X_WS, X_WB, index_or_none(render.hidden),
                            render.with_depth);
}

// --- replies ------------------------------------------------------------------------------------

Offset<wire::Touch> write(FlatBufferBuilder& b, const Touch& touch) {
  const auto with = b.CreateString(touch.with);
  return wire::CreateTouch(b, to_ns(touch.at), touch.uav, with, touch.shape, touch.speed_m_s);
}

Offset<wire::State> write(FlatBufferBuilder& b, const State& state) {
  const auto bodies = structs<wire::BodyState>(b, state.bodies);
  const auto motions = structs<wire::Motion>(b, state.motions);
  const auto past = structs<wire::Pose>(b, state.past);
  Offset<Vector<Offset<wire::Touch>>> touches;
  if (!state.touches.empty()) {
    touches = tables<wire::Touch>(b, state.touches, [](FlatBufferBuilder& to, const Touch& touch) {
      return write(to, touch);
    });
  }
  return wire::CreateState(b, to_ns(state.now), bodies, motions, past, touches);
}

Content write(FlatBufferBuilder& b, const Opened& opened, PictureSlot&) {
  const auto description = b.CreateString(opened.description);
  const auto state = write(b, opened.state);
  return wire::CreateOpened(b, description, state, opened.reports_contacts);
}
Content write(FlatBufferBuilder& b, const State& state, PictureSlot&) {
  return write(b, state);
}
Content write(FlatBufferBuilder& b, const Distances& distances, PictureSlot&) {
  const auto distance_m = b.CreateVector(distances.distance_m);
  return wire::CreateDistances(b, distance_m);
}
/// Leaves room for the pixels without touching it. Being written first, they lie at the end of the
/// buffer (it grows downwards), so that a frame is one piece before them and, at most, padding
/// after.
Content write(FlatBufferBuilder& b, const Picture& picture, PictureSlot& slot) {
  std::uint8_t* room = nullptr;
  const Offset<Vector<std::uint8_t>> rgb(
      b.CreateUninitializedVector<std::uint8_t>(picture.rgb.size(), &room));
  slot = {picture.rgb, rgb.o};
  const auto renderer = b.CreateString(picture.renderer);
  return wire::CreatePicture(b, picture.width_px, picture.height_px, rgb, picture.nearest_depth_m,
                             renderer);
}
Content write(FlatBufferBuilder& b, const Failed& failed, PictureSlot&) {
  return wire::CreateFailed(b, b.CreateString(failed.message));
}

}  // namespace

struct Encoder::Impl {
  FlatBufferBuilder builder;

  template <class Message>
  link::FramePieces encode(const Message& message) {
    builder.Clear();
    PictureSlot slot;
    const Content content =
        std::visit([&](const auto& m) { return write(builder, m, slot); }, message);
    wire::FinishSizePrefixedEnvelopeBuffer(builder,
                                           wire::CreateEnvelope(builder, content.kind, content.at));
    const std::span<const std::uint8_t> frame(builder.GetBufferPointer(), builder.GetSize());
    if (slot.pixels.empty()) return {frame, {}, {}};
    const std::size_t begin = frame.size() - slot.end_distance + sizeof(flatbuffers::uoffset_t);
    return {frame.first(begin), slot.pixels, frame.subspan(begin + slot.pixels.size())};
  }
};

Encoder::Encoder() : impl_(std::make_unique<Impl>()) {}
Encoder::~Encoder() = default;

link::FramePieces Encoder::encode(const Request& message) {
  return impl_->encode(message);
}
link::FramePieces Encoder::encode(const Reply& message) {
  return impl_->encode(message);
}

}  // namespace tether::sim::protocol
