#pragma once

#include <string>
#include <string_view>

#include <tether/record/messages.h>

/// Messages of the record as JSON. Times are integers [ns], members are named as in messages.h with
/// the unit at the end; an absent optional has no member.
namespace tether::record {

/// Which members of a message to write; `schemas.cpp` describes the whole.
struct JsonParts {
  bool wall = true;      ///< host clock readings, under "wall"
  bool arrivals = true;  ///< ST at arrival and the lag
};

void append_json(std::string& out, const Interaction& message, JsonParts parts = {});
void append_json(std::string& out, const CommandEffect& message);
void append_json(std::string& out, const GroundTruth& message);
void append_json(std::string& out, const Annotation& message);
void append_json(std::string& out, const Stop& message, JsonParts parts = {});
void append_json(std::string& out, const Contact& message);
void append_json(std::string& out, const Battery& message);
void append_json(std::string& out, const RadioMessage& message);
/// As foxglove.CompressedImage, with more members.
void append_json(std::string& out, const Image& message);
/// As foxglove.RawImage, with more members.
void append_json(std::string& out, const RawImage& message);
/// The pose of a ground truth message as foxglove.FrameTransform: "world" to the UAV's name.
void append_frame_transform(std::string& out, const GroundTruth& message);

/// The inverse. @throws Damage naming the member that is missing or wrong.
Interaction interaction_from_json(std::string_view text);
CommandEffect command_effect_from_json(std::string_view text);
GroundTruth ground_truth_from_json(std::string_view text);
Annotation annotation_from_json(std::string_view text);
Stop stop_from_json(std::string_view text);
Contact contact_from_json(std::string_view text);
Battery battery_from_json(std::string_view text);
RadioMessage radio_message_from_json(std::string_view text);
Image image_from_json(std::string_view text);
RawImage raw_image_from_json(std::string_view text);

}  // namespace tether::record
