#include "camera/camera.h"

#include "clocks.h"
#include "real.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

constexpr std::uint32_t kMostBuffers = 32;
constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
constexpr std::uint32_t kVersion = 0x06'01'00;  // of Debian 12's kernel

template <class Text, std::size_t kSize>
void write(Text (&field)[kSize], const std::string& text) {
  std::snprintf(reinterpret_cast<char*>(field), kSize, "%s", text.c_str());
}

v4l2_fract period_of(double rate_hz) {
  const auto per_1000s = static_cast<std::uint32_t>(std::lround(rate_hz * 1000.0));
  const std::uint32_t common = std::gcd(1000u, per_1000s);
  return {1000u / common, per_1000s / common};
}

}  // namespace

Camera::Camera(const uav::SensorDescription& sensor, unsigned number, Images images)
    : sensor_(sensor.name),
      number_(number),
      width_px_(std::get<uav::CameraProperties>(sensor.properties).model.width_px),
      height_px_(std::get<uav::CameraProperties>(sensor.properties).model.height_px),
      period_s_(period_of(sensor.rate_hz)),
      images_(std::move(images)),
      format_(&pixel_formats().front()) {}

Camera::~Camera() {
  free_buffers();
}

int Camera::answer(const Opener& by, unsigned long request, void* argument) {
  if (argument == nullptr) return EFAULT;
  const auto code = static_cast<std::uint32_t>(request);  // some pass it with a sign
  const int result = answer_about_itself(code, argument);
  return result == ENOTTY ? answer_about_buffers(by, code, argument) : result;
}

// It has no controls: asked for any, it is as a driver that has others.
int Camera::answer_about_itself(std::uint32_t request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      describe(*static_cast<v4l2_capability*>(argument));
      return 0;
    case VIDIOC_ENUM_FMT:
      return describe(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return describe(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return describe(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_ENUMINPUT:
      return describe(*static_cast<v4l2_input*>(argument));
    case VIDIOC_G_INPUT:
      *static_cast<int*>(argument) = 0;
      return 0;
    case VIDIOC_S_INPUT:
      return *static_cast<const int*>(argument) == 0 ? 0 : EINVAL;
    case VIDIOC_G_FMT: {
      auto& format = *static_cast<v4l2_format*>(argument);
      if (format.type != kCapture) return EINVAL;
      format.fmt.pix = described(*format_);
      return 0;
    }
    case VIDIOC_TRY_FMT:
    case VIDIOC_S_FMT:
      return set_format(*static_cast<v4l2_format*>(argument), request == VIDIOC_TRY_FMT);
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      return describe(*static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_QUERYCTRL:
    case VIDIOC_QUERY_EXT_CTRL:
    case VIDIOC_QUERYMENU:
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
    case VIDIOC_G_EXT_CTRLS:
    case VIDIOC_S_EXT_CTRLS:
    case VIDIOC_TRY_EXT_CTRLS:
      return EINVAL;
    default:
      return ENOTTY;
  }
}

// The buffers belong to the one that requested them.
int Camera::answer_about_buffers(const Opener& by, std::uint32_t request, void* argument) {
  const bool is_others = owner_ != nullptr && owner_ != &by;
  auto* const buffer = static_cast<v4l2_buffer*>(argument);
  switch (request) {
    case VIDIOC_QUERYBUF:
      if (buffer->type != kCapture || buffer->index >= buffers_.size()) return EINVAL;
      describe(buffer->index, *buffer);
      return 0;
    case VIDIOC_REQBUFS:
      return is_others ? EBUSY : request_buffers(by, *static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QBUF:
    case VIDIOC_DQBUF:
      if (is_others) return EBUSY;
      if (buffer->type != kCapture || buffer->memory != V4L2_MEMORY_MMAP) return EINVAL;
      return request == VIDIOC_QBUF ? queue(*buffer) : dequeue(*buffer);
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      if (is_others) return EBUSY;
      if (*static_cast<const std::uint32_t*>(argument) != kCapture) return EINVAL;
      if (request == VIDIOC_STREAMON) return stream();
      stop();
      return 0;
    default:
      return ENOTTY;
  }
}

void Camera::describe(v4l2_capability& capability) const {
  capability = {};
  write(capability.driver, "tether");
  write(capability.card, sensor_);
  write(capability.bus_info, "platform:tether-" + std::to_string(number_));
  capability.version = kVersion;
  capability.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  capability.capabilities = capability.device_caps | V4L2_CAP_DEVICE_CAPS;
}

int Camera::describe(v4l2_fmtdesc& format) const {
  if (format.type != kCapture || format.index >= pixel_formats().size()) return EINVAL;
  const PixelFormat& found = pixel_formats()[format.index];
  format.flags = found.is_compressed() ? V4L2_FMT_FLAG_COMPRESSED : 0;
  write(format.description, found.name);
  format.pixelformat = found.code;
  return 0;
}

int Camera::describe(v4l2_frmsizeenum& size) const {
  if (size.index > 0 || pixel_format(size.pixel_format).code != size.pixel_format) return EINVAL;
  size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  size.discrete = {static_cast<std::uint32_t>(width_px_), static_cast<std::uint32_t>(height_px_)};
  return 0;
}

int Camera::describe(v4l2_frmivalenum& interval) const {
  if (interval.index > 0 || pixel_format(interval.pixel_format).code != interval.pixel_format ||
      interval.width != static_cast<std::uint32_t>(width_px_) ||
      interval.height != static_cast<std::uint32_t>(height_px_))
    return EINVAL;
  interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  interval.discrete = period_s_;
  return 0;
}

int Camera::describe(v4l2_input& input) const {
  if (input.index > 0) return EINVAL;
  input = {};
  write(input.name, sensor_);
  input.type = V4L2_INPUT_TYPE_CAMERA;
  return 0;
}

int Camera::describe(v4l2_streamparm& parameters) const {
  if (parameters.type != kCapture) return EINVAL;
  parameters.parm.capture = {};
  parameters.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
  parameters.parm.capture.timeperframe = period_s_;
  return 0;
}

v4l2_pix_format Camera::described(const PixelFormat& format) const {
  v4l2_pix_format out{};
  out.width = static_cast<std::uint32_t>(width_px_);
  out.height = static_cast<std::uint32_t>(height_px_);
  out.pixelformat = format.code;
  out.field = V4L2_FIELD_NONE;
  out.bytesperline = format.line_bytes(width_px_);
  out.sizeimage = format.image_bytes(width_px_, height_px_);
  out.colorspace = V4L2_COLORSPACE_SRGB;
  return out;
}

int Camera::set_format(v4l2_format& format, bool tries_only) {
  if (format.type != kCapture) return EINVAL;
  if (!tries_only && !buffers_.empty()) return EBUSY;
  const PixelFormat& found = pixel_format(format.fmt.pix.pixelformat);
  format.fmt.pix = described(found);
  if (!tries_only) format_ = &found;
  return 0;
}

// --- buffers ------------------------------------------------------------------------------------

int Camera::request_buffers(const Opener& by, v4l2_requestbuffers& request) {
  if (request.type != kCapture || request.memory != V4L2_MEMORY_MMAP) return EINVAL;
  request.capabilities = V4L2_BUF_CAP_SUPPORTS_MMAP;
  stop();
  free_buffers();
  if (request.count == 0) return 0;
  request.count = std::min(request.count, kMostBuffers);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t image = format_->image_bytes(width_px_, height_px_);
  const std::size_t each = (image + page - 1) / page * page, all = request.count * each;
  const int memory = ::memfd_create("tether-camera", MFD_CLOEXEC);
  void* const mapped = memory < 0 || ::ftruncate(memory, static_cast<off_t>(all)) != 0
                           ? MAP_FAILED
                           : ::mmap(nullptr, all, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  if (mapped == MAP_FAILED) {
    if (memory >= 0) ::close(memory);
    return ENOMEM;
  }
  memory_ = memory;
  mapped_ = static_cast<std::uint8_t*>(mapped);
  buffer_bytes_ = each;
  buffers_.resize(request.count);
  owner_ = &by;
  return 0;
}

// What the program has mapped stays as long as it is mapped.
void Camera::free_buffers() {
  if (memory_ >= 0) {
    ::munmap(mapped_, memory_bytes());
    ::close(memory_);
  }
  memory_ = -1;
  buffers_.clear();
  owner_ = nullptr;
}

void Camera::close(const Opener& by) {
  if (owner_ != &by) return;
  stop();
  free_buffers();
}

void Camera::describe(std::uint32_t index, v4l2_buffer& buffer) const {
  const Buffer& own = buffers_[index];
  buffer = {};
  buffer.index = index;
  buffer.type = kCapture;
  buffer.bytesused = own.bytes;
  buffer.length = format_->image_bytes(width_px_, height_px_);
  buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  if (own.state == State::kQueued) buffer.flags |= V4L2_BUF_FLAG_QUEUED;
  if (own.state == State::kFilled) buffer.flags |= V4L2_BUF_FLAG_DONE;
  buffer.field = V4L2_FIELD_NONE;
  buffer.timestamp = own.stamp;
  buffer.sequence = own.sequence;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.m.offset = static_cast<std::uint32_t>(index * buffer_bytes_);
}

// What arrived before it did so without this buffer.
int Camera::queue(v4l2_buffer& buffer) {
  if (buffer.index >= buffers_.size()) return EINVAL;
  Buffer& own = buffers_[buffer.index];
  if (own.state != State::kWithProgram) return EINVAL;
  take_arrived();
  if (is_streaming_ && queued_.empty()) images_.drop(true);
  own.state = State::kQueued;
  queued_.push_back(buffer.index);
  describe(buffer.index, buffer);
  return 0;
}

int Camera::dequeue(v4l2_buffer& buffer) {
  if (!is_streaming_) return EINVAL;
  if (filled_.empty()) return EAGAIN;
  const std::uint32_t index = filled_.front();
  filled_.pop_front();
  std::uint64_t one = 0;
  static_cast<void>(TETHER_REAL(read)(owner_->signal, &one, sizeof one));
  buffers_[index].state = State::kWithProgram;
  describe(index, buffer);
  return 0;
}

int Camera::stream() {
  if (buffers_.empty()) return EINVAL;
  if (is_streaming_) return 0;
  images_.drop(true);
  is_streaming_ = true;
  streams_since_ = images_.now();
  first_index_.reset();
  return 0;
}

// All buffers are the program's again. Nothing need be kept for it any more.
void Camera::stop() {
  if (is_streaming_) images_.drop(false);
  is_streaming_ = false;
  for (std::size_t i = 0; i < filled_.size(); ++i) {
    std::uint64_t one = 0;
    static_cast<void>(TETHER_REAL(read)(owner_->signal, &one, sizeof one));
  }
  queued_.clear();
  filled_.clear();
  for (Buffer& buffer : buffers_) buffer.state = State::kWithProgram;
}

// The sensor begins when the stream does: what was sampled before is none of it.
void Camera::take_arrived() {
  while (has_room()) {
    const auto image = images_.take();
    if (!image) return;
    if (image->sampled_at >= same_instant(streams_since_)) fill(*image);
  }
}

void Camera::fill(const uav::CameraSample& image) {
  const std::uint32_t index = queued_.front();
  queued_.pop_front();
  filled_.push_back(index);
  if (!first_index_) first_index_ = image.index;
  const timespec stamp = shown(CLOCK_MONOTONIC, same_instant(image.sampled_at));
  buffers_[index] = {
      .state = State::kFilled,
      .sequence = static_cast<std::uint32_t>(image.index - *first_index_),
      .bytes = format_->convert(image.rgb, width_px_, height_px_, mapped_ + index * buffer_bytes_),
      .stamp = {stamp.tv_sec, stamp.tv_nsec / 1000}};
  constexpr std::uint64_t kOne = 1;
  static_cast<void>(TETHER_REAL(write)(owner_->signal, &kOne, sizeof kOne));
}

}  // namespace tether::as_is
