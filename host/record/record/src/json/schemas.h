#pragma once

#include <string_view>

/// JSON schemas of the topics, for readers that show or plot messages. Foxglove shows no topic with
/// a property that has several types, or that is an object without "properties": so a number that
/// is not finite, null in the message, is a "number" in the schema.
namespace tether::record {

struct Schema {
  std::string_view name;
  std::string_view json;
};

extern const Schema kInteractionSchema;
extern const Schema kCommandEffectSchema;
extern const Schema kGroundTruthSchema;
extern const Schema kAnnotationSchema;
extern const Schema kStopSchema;
extern const Schema kContactSchema;
extern const Schema kBatterySchema;
extern const Schema kRadioMessageSchema;
extern const Schema kAutopilotMessageSchema;
extern const Schema kMarginSchema;
/// Well-known schemas of Foxglove, by their names.
extern const Schema kCompressedImageSchema;
extern const Schema kRawImageSchema;
extern const Schema kFrameTransformSchema;

}  // namespace tether::record
