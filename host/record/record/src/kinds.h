#pragma once

#include "json/schemas.h"

#include <string_view>
#include <tuple>
#include <vector>

#include <tether/record/reader.h>

namespace tether::record {

/// A kind of message: where a file and a Record have it.
template <class OfKind>
struct KindInfo {
  using Kind = OfKind;
  const Schema& schema;
  std::string_view topic;  ///< or its beginning
  std::vector<Logged<Kind>> Record::*messages;
};

/// In the order of Message.
inline const std::tuple kKinds = {
    KindInfo<Interaction>{kInteractionSchema, "/interactions", &Record::interactions},
    KindInfo<CommandEffect>{kCommandEffectSchema, "/commands", &Record::commands},
    KindInfo<GroundTruth>{kGroundTruthSchema, "/ground_truth", &Record::ground_truth},
    KindInfo<Annotation>{kAnnotationSchema, "/task", &Record::annotations},
    KindInfo<Stop>{kStopSchema, "/stops", &Record::stops},
    KindInfo<Contact>{kContactSchema, "/contacts", &Record::contacts},
    KindInfo<Battery>{kBatterySchema, "/battery", &Record::batteries},
    KindInfo<RadioMessage>{kRadioMessageSchema, "/radio", &Record::radio},
    KindInfo<AutopilotMessage>{kAutopilotMessageSchema, "/autopilot", &Record::autopilot},
    KindInfo<Image>{kCompressedImageSchema, "/images", &Record::images},
    KindInfo<RawImage>{kRawImageSchema, "/depth", &Record::raw_images},
};

template <class Kind>
std::vector<Logged<Kind>>& messages_of(Record& record) {
  return record.*std::get<KindInfo<Kind>>(kKinds).messages;
}

template <class Kind>
inline constexpr bool kIsImage = std::is_same_v<Kind, Image> || std::is_same_v<Kind, RawImage>;

}  // namespace tether::record
