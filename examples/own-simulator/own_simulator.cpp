// A complete external simulator in one file. It uses only the schema of Tether's protocol
// (docs/guide/simulator-protocol.md).
//
//   own_simulator /path/of/socket
//
// It has one world, the yard of yard.sdf, and one UAV. The UAV follows each command at once, with
// limited acceleration, and never tilts.
//
// Parts: cast() intersects one ray with the yard; Simulator replies to each request; serve() moves
// frames between a socket and a Simulator.
#include "simulator_generated.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace wire = tether::sim::protocol::wire;
using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

// --- vectors

struct Vec {
  double x = 0, y = 0, z = 0;
};
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec operator*(double s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double norm(Vec a) {
  return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}
Vec from(const wire::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
wire::Vec3 to_wire(Vec v) {
  return {v.x, v.y, v.z};
}
Vec rotate(const wire::Quat& q, Vec v) {
  const Vec u{q.x(), q.y(), q.z()};
  const Vec t = 2.0 * cross(u, v);
  return v + q.w() * t + cross(u, t);
}
wire::Quat turned_left(double yaw_rad) {
  return {std::cos(yaw_rad / 2), 0, 0, std::sin(yaw_rad / 2)};
}

// --- the yard: what a ray hits

const Vec kBox{5.0, 0.5, 1.2};  // centre; see yard.sdf
constexpr double kHalfEdge = 0.2;
constexpr double kNothing = std::numeric_limits<double>::infinity();

struct Hit {
  double distance_m = kNothing;
  std::uint8_t rgb[3] = {170, 200, 230};  // the sky
};

Hit cast(Vec from_W, Vec ray_W) {
  Hit hit;
  if (ray_W.z < 0 && from_W.z > 0) {  // the ground, in squares of 1 m
    hit.distance_m = -from_W.z / ray_W.z;
    const Vec at = from_W + hit.distance_m * ray_W;
    const bool light = (std::llround(std::floor(at.x)) + std::llround(std::floor(at.y))) % 2 == 0;
    std::fill_n(hit.rgb, 3, static_cast<std::uint8_t>(light ? 150 : 120));
  }
  const Vec o = from_W - kBox;
  double first = -kNothing, last = kNothing;
  for (const auto& [at, along] : {std::pair(o.x, ray_W.x), {o.y, ray_W.y}, {o.z, ray_W.z}}) {
    if (along == 0 && std::abs(at) > kHalfEdge) return hit;
    if (along == 0) continue;
    first = std::max(first, (-std::copysign(kHalfEdge, along) - at) / along);
    last = std::min(last, (std::copysign(kHalfEdge, along) - at) / along);
  }
  if (first >= 0 && first <= last && first < hit.distance_m) hit = {first, {13, 38, 217}};
  return hit;
}

// --- the simulator: one reply to each request

class Simulator {
 public:
  // The reply as a frame, with its size prefix.
  FlatBufferBuilder answer(const wire::Envelope& request) {
    FlatBufferBuilder b;
    try {
      const bool opens = request.content_type() == wire::Content::Open;
      if (opens == is_open_)
        throw std::runtime_error("Open must be the first message, and the only one of its kind");
      switch (request.content_type()) {
        case wire::Content::Open:
          return open(b, *request.content_as_Open());
        case wire::Content::Reset:
          return reset(b);
        case wire::Content::Advance:
          return advance(b, *request.content_as_Advance());
        case wire::Content::CastRays:
          return cast_rays(b, *request.content_as_CastRays());
        case wire::Content::Render:
          return render(b, *request.content_as_Render());
        default:
          throw std::runtime_error("not a request");
      }
    } catch (const std::exception& error) {
      b.Clear();
      return reply(b, wire::Content::Failed,
                   wire::CreateFailed(b, b.CreateString(error.what())).Union());
    }
  }

 private:
  static FlatBufferBuilder reply(FlatBufferBuilder& b, wire::Content kind, Offset<void> content) {
    wire::FinishSizePrefixedEnvelopeBuffer(b, wire::CreateEnvelope(b, kind, content));
    return std::move(b);
  }

  FlatBufferBuilder open(FlatBufferBuilder& b, const wire::Open& open) {
    if (open.version() != 1)
      throw std::runtime_error("unsupported protocol version; own_simulator has version 1");
    if (open.world_name()->str() != "yard")
      throw std::runtime_error("own_simulator knows the yard only");
    if (open.uavs()->size() != 1 || open.bodies()->size() != 0) {
      throw std::runtime_error("own_simulator simulates one UAV and no other moving body");
    }
    if (open.step_ns() < 1) throw std::runtime_error("step_ns must be at least 1");
    dt_ns_ = open.step_ns();
    past_steps_ = open.past_steps();
    const wire::Pose& start = *open.uavs()->Get(0)->x_wb();
    start_p_ = from(start.p());
    start_yaw_ = 2 * std::atan2(start.q().z(), start.q().w());
    back_to_start();
    is_open_ = true;
    const auto name = b.CreateString("own_simulator 1.0");
    return reply(b, wire::Content::Opened, wire::CreateOpened(b, name, state(b)).Union());
  }

  FlatBufferBuilder reset(FlatBufferBuilder& b) {
    back_to_start();
    return reply(b, wire::Content::State, state(b).Union());
  }

  FlatBufferBuilder advance(FlatBufferBuilder& b, const wire::Advance& advance) {
    for (const wire::Command* c : *advance.commands()) {
      command_ = from(c->velocity_h_m_s());
      yaw_command_ = c->yaw_rate_rad_s();
    }
    past_.clear();
    while (now_ns_ < advance.to_st_ns()) {
      if ((advance.to_st_ns() - now_ns_) / dt_ns_ <= past_steps_) past_.push_back(pose());
      step(static_cast<double>(dt_ns_) * 1e-9);
      now_ns_ += dt_ns_;
    }
    return reply(b, wire::Content::State, state(b).Union());
  }

  // Distances along rays from a pose that the host gives. Only the UAV itself moves in the yard, so
  // the poses of bodies have no effect here.
  FlatBufferBuilder cast_rays(FlatBufferBuilder& b, const wire::CastRays& request) {
    std::vector<double> distances;
    for (const wire::Vec3* ray : *request.rays_s()) {
      const wire::Pose& X_WS = *request.x_ws();
      distances.push_back(cast(from(X_WS.p()), rotate(X_WS.q(), from(*ray))).distance_m);
    }
    return reply(b, wire::Content::Distances,
                 wire::CreateDistances(b, b.CreateVector(distances)).Union());
  }

  FlatBufferBuilder render(FlatBufferBuilder& b, const wire::Render& r) {
    if (std::min(r.width_px(), r.height_px()) < 1 || std::max(r.width_px(), r.height_px()) > 4096) {
      throw std::runtime_error("wrong size of a picture");
    }
    std::uint8_t* rgb = nullptr;
    const auto pixels = b.CreateUninitializedVector<std::uint8_t>(
        static_cast<std::size_t>(3) * static_cast<std::size_t>(r.width_px() * r.height_px()), &rgb);
    double nearest = r.far_m();
    for (int v = 0; v < r.height_px(); ++v) {
      for (int u = 0; u < r.width_px(); ++u, rgb += 3) {
        // The pixel's point 1 m ahead (x ahead, y left, z up).
        const Vec ray{1.0, (r.cx_px() - u) / r.focal_px(), (r.cy_px() - v) / r.focal_px()};
        const Hit hit = cast(from(r.x_ws()->p()), rotate(r.x_ws()->q(), (1 / norm(ray)) * ray));
        std::memcpy(rgb, hit.rgb, 3);
        nearest = std::min(nearest, hit.distance_m / norm(ray));
      }
    }
    nearest = std::max(nearest, r.near_m());
    const auto renderer = b.CreateString("rays");
    return reply(
        b, wire::Content::Picture,
        wire::CreatePicture(b, r.width_px(), r.height_px(), pixels, nearest, renderer).Union());
  }

  void back_to_start() {
    now_ns_ = 0;
    past_.clear();
    p_ = start_p_;
    yaw_ = start_yaw_;
    yaw_rate_ = yaw_command_ = yaw_acceleration_ = 0;
    v_ = a_ = command_ = Vec{};
  }

  // Commands are in the heading frame, which turns with the UAV.
  void step(double dt) {
    const Vec wanted = rotate(turned_left(yaw_), command_) - v_;
    a_ = std::min(5.0, 3.0 / std::max(norm(wanted), 1e-9)) * wanted;
    yaw_acceleration_ = std::clamp(10.0 * (yaw_command_ - yaw_rate_), -6.0, 6.0);
    v_ = v_ + dt * a_;
    yaw_rate_ += dt * yaw_acceleration_;
    p_ = p_ + dt * v_;
    yaw_ += dt * yaw_rate_;
  }

  wire::Pose pose() const { return {to_wire(p_), turned_left(yaw_)}; }

  Offset<wire::State> state(FlatBufferBuilder& b) const {
    const std::vector<wire::BodyState> bodies{
        {to_wire(p_), turned_left(yaw_), to_wire(v_), {0, 0, yaw_rate_}}};
    const std::vector<wire::Motion> motions{{to_wire(a_), {0, 0, yaw_acceleration_}}};
    const auto body_list = b.CreateVectorOfStructs(bodies);
    const auto motion_list = b.CreateVectorOfStructs(motions);
    return wire::CreateState(b, now_ns_, body_list, motion_list, b.CreateVectorOfStructs(past_));
  }

  bool is_open_ = false;
  std::int64_t now_ns_ = 0, dt_ns_ = 1, past_steps_ = 0;
  Vec start_p_, p_, v_, a_, command_;
  double start_yaw_ = 0, yaw_ = 0, yaw_rate_ = 0, yaw_acceleration_ = 0, yaw_command_ = 0;
  std::vector<wire::Pose> past_;
};

// --- frames over a socket

bool receive(int socket, std::uint8_t* to, std::size_t bytes) {
  return ::recv(socket, to, bytes, MSG_WAITALL) == static_cast<ssize_t>(bytes);
}

// A frame is a length (uint32, little-endian), followed by that number of bytes.
bool receive_frame(int socket, std::vector<std::uint8_t>& frame) {
  constexpr std::uint32_t kMost = 64u << 20;
  frame.resize(4);
  if (!receive(socket, frame.data(), 4)) return false;
  const std::uint32_t length = flatbuffers::ReadScalar<std::uint32_t>(frame.data());
  if (length > kMost) return false;
  frame.resize(4 + length);
  return receive(socket, frame.data() + 4, length);
}

bool send_frame(int socket, const FlatBufferBuilder& b) {
  const std::uint8_t* data = b.GetBufferPointer();
  for (std::size_t left = b.GetSize(); left > 0;) {
    const ssize_t sent = ::send(socket, data, left, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    data += sent;
    left -= static_cast<std::size_t>(sent);
  }
  return true;
}

// One run: ends when the host closes the connection.
void serve(int socket) {
  Simulator simulator;
  std::vector<std::uint8_t> frame;
  while (receive_frame(socket, frame)) {
    flatbuffers::Verifier verifier(frame.data(), frame.size());
    if (!wire::VerifySizePrefixedEnvelopeBuffer(verifier)) return;
    if (!send_frame(socket, simulator.answer(*wire::GetSizePrefixedEnvelope(frame.data())))) return;
  }
}

int main(int count, char** arguments) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (count != 2 || std::strlen(arguments[1]) >= sizeof address.sun_path) {
    std::fprintf(stderr, "usage: own_simulator /path/of/socket\n");
    return 2;
  }
  std::strcpy(address.sun_path, arguments[1]);
  ::unlink(address.sun_path);
  ::umask(0077);  // only the owner can connect
  const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listening, 1) != 0) {
    std::perror(arguments[1]);
    return 1;
  }
  std::printf("listening on unix:%s\n", arguments[1]);
  std::fflush(stdout);
  while (true) {
    const int socket = ::accept(listening, nullptr, nullptr);
    if (socket < 0) continue;
    serve(socket);
    ::close(socket);
  }
}
