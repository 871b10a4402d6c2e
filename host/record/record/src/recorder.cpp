// Puts messages into an MCAP file: Channels makes a channel for each topic when its first message
// comes, and McapWriter packs the messages into chunks.

#include "json/json_messages.h"
#include "json/json_metadata.h"
#include "json/json_text.h"
#include "json/members.h"
#include "kinds.h"
#include "mcap/mcap_writer.h"

#include <algorithm>
#include <functional>
#include <string>
#include <unordered_map>

#include <tether/base/error.h>
#include <tether/record/writer.h>

namespace tether::record {
namespace {

// Fixed, so that equal runs give equal files. The version of Tether is in the header.
constexpr std::string_view kLibrary = "tether";

// Channels of one schema, one per topic, added with the first message. They are looked up by the
// parts of the topic, so that a message needs no concatenation.
class Channels {
 public:
  Channels(McapWriter& mcap, const Schema& schema) : mcap_(mcap), schema_(schema) {}

  std::uint16_t of(std::string_view prefix, std::string_view uav, std::string_view sensor = {}) {
    const auto of_uav = ids_.find(uav);
    if (of_uav != ids_.end()) {
      const auto found = of_uav->second.find(sensor);
      if (found != of_uav->second.end()) return found->second;
    }
    return add(prefix, uav, sensor);
  }

 private:
  std::uint16_t add(std::string_view prefix, std::string_view uav, std::string_view sensor) {
    if (schema_id_ == 0) schema_id_ = mcap_.add_schema(schema_.name, "jsonschema", schema_.json);
    std::string topic(prefix);
    for (const std::string_view part : {uav, sensor}) {
      topic += part.empty() ? "" : "/" + to_utf8(part);
    }
    const std::uint16_t id = mcap_.add_channel(topic, schema_id_, "json");
    ids_[std::string(uav)][std::string(sensor)] = id;
    return id;
  }

  McapWriter& mcap_;
  const Schema& schema_;
  std::uint16_t schema_id_ = 0;
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  template <class Value>
  using ByName = std::unordered_map<std::string, Value, Hash, std::equal_to<>>;
  ByName<ByName<std::uint16_t>> ids_;  // by UAV and sensor
};

class McapRecorder final : public Recorder {
 public:
  explicit McapRecorder(const std::filesystem::path& file) : mcap_(file, kLibrary) {}

  // The run was interrupted: writes the last chunk. A second failure would add no information.
  ~McapRecorder() override {
    try {
      if (!finished_) mcap_.flush();
    } catch (const Error&) {
    }
  }

  void write(const Header& header) override {
    mcap_.add_metadata(kHeaderName, to_metadata(header));
  }

  void write(SimTime at, const Message& message) override {
    std::visit([&](const auto& one) { put(at, one, message.index()); }, message);
  }

  void flush() override { mcap_.flush(); }

  void write(const Footer& footer) override {
    Footer counted = footer;
    counted.topics = mcap_.counts();
    mcap_.add_metadata(kFooterName, to_metadata(counted));
    mcap_.finish();
    finished_ = true;
  }

 private:
  template <class Kind>
  void put(SimTime at, const Kind& message, std::size_t kind) {
    constexpr bool is_of_all =
        std::is_same_v<Kind, Interaction> || std::is_same_v<Kind, RadioMessage>;
    Channels* channels = &channels_[kind];
    std::string_view topic = std::get<KindInfo<Kind>>(kKinds).topic, uav, sensor;
    if constexpr (!is_of_all) uav = message.uav;
    if constexpr (kIsImage<Kind>) sensor = message.sensor;
    std::string part;
    if constexpr (std::is_same_v<Kind, AutopilotMessage>) {
      part = message.direction();
      part += '/' + (message.name.empty() ? "unknown" : message.name);
      sensor = part;
    }
    if constexpr (std::is_same_v<Kind, RawImage>)
      if (!std::holds_alternative<std::vector<float>>(message.pixels))
        std::tie(channels, topic) = std::pair(&labels_, "/labels");
    write_json(channels->of(topic, uav, sensor), at, message);
    if constexpr (std::is_same_v<Kind, GroundTruth>) {
      append_frame_transform(begin(transforms_.of("/tf", {}), at), message);
      mcap_.end_message();
    }
  }

  std::string& begin(std::uint16_t channel, SimTime at) {
    return mcap_.begin_message(channel, static_cast<std::uint64_t>(to_ns(at)));
  }
  template <class Kind>
  void write_json(std::uint16_t channel, SimTime at, const Kind& message) {
    append_json(begin(channel, at), message);
    mcap_.end_message();
  }

  McapWriter mcap_;
  std::vector<Channels> channels_ = std::apply(
      [this](const auto&... kinds) { return std::vector{Channels(mcap_, kinds.schema)...}; },
      kKinds);
  Channels labels_{mcap_, kRawImageSchema};
  Channels transforms_{mcap_, kFrameTransformSchema};
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<Recorder> make_mcap_recorder(const std::filesystem::path& file) {
  return std::make_unique<McapRecorder>(file);
}

void write_margins(const std::filesystem::path& file, std::vector<Margin> margins) {
  std::ranges::stable_sort(margins, {}, &Margin::at);
  McapWriter mcap(file, kLibrary);
  Channels channels(mcap, kMarginSchema);
  for (const Margin& margin : margins) {
    std::string& out = mcap.begin_message(channels.of("/margins", margin.uav),
                                          static_cast<std::uint64_t>(to_ns(margin.at)));
    append_members(out, margin);
    mcap.end_message();
  }
  mcap.finish();
}

}  // namespace tether::record
