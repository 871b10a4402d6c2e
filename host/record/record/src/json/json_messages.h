#pragma once

#include "json/json_members.h"

#include <string>
#include <string_view>

/// Messages of the record as JSON. Times are integers [ns], members are named as in messages.h with
/// the unit at the end; an absent optional has no member.
namespace tether::record {

template <class Kind>
void append_json(std::string& out, const Kind& message, JsonParts parts = {}) {
  append_members(out, message, parts);
}
void append_json(std::string& out, const Annotation& message);
void append_json(std::string& out, const AutopilotMessage& message);
/// As foxglove.CompressedImage, with more members.
void append_json(std::string& out, const Image& message);
/// As foxglove.RawImage, with more members.
void append_json(std::string& out, const RawImage& message);
/// The pose of a ground truth message as foxglove.FrameTransform: "world" to the UAV's name.
void append_frame_transform(std::string& out, const GroundTruth& message);

/// The inverse. @throws Damage naming the member that is missing or wrong.
template <class Kind>
Kind from_json(std::string_view text) {
  return read_members<Kind>(parse_object(text));
}
template <>
Annotation from_json<Annotation>(std::string_view text);
template <>
AutopilotMessage from_json<AutopilotMessage>(std::string_view text);
template <>
Image from_json<Image>(std::string_view text);
template <>
RawImage from_json<RawImage>(std::string_view text);

}  // namespace tether::record
