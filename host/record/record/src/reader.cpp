#include "damage.h"
#include "json/json_messages.h"
#include "json/json_metadata.h"
#include "kinds.h"
#include "mcap/mcap_reader.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/record/reader.h>

namespace tether::record {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::kBadFile, FileLocation{file.string(), 0}, what);
}

// Sorts the messages of a file by their schemas.
class RecordBuilder final : public McapVisitor {
 public:
  RecordBuilder(const std::filesystem::path& file, const ReadOptions& options)
      : file_(file), options_(options) {}

  void channel(const McapChannel& channel) override {
    Channel& known = channels_[channel.id];
    known.topic = channel.topic;
    known.append = appender(channel.schema_name);
  }

  void message(const McapMessage& message) override {
    Channel& channel = channels_[message.channel];
    if (channel.append == nullptr || channel.append == &RecordBuilder::skip) ++channel.unloaded;
    if (channel.append == nullptr) return;
    if (message.log_time_ns > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      throw Damage("a log time is out of range");
    const auto at = from_ns<SimTime>(static_cast<std::int64_t>(message.log_time_ns));
    try {
      (this->*channel.append)(at, message.data);
    } catch (const Damage& damage) {
      throw Damage("message " + std::to_string(message.sequence) + " of " + channel.topic + ": " +
                   damage.what());
    }
    count(message.sequence, at, channel);
    ++order_;
  }

  void metadata(std::string_view name, const StringMap& values) override {
    if (name == kHeaderName && !has_header_) {
      read_header(values);
    } else if (name == kFooterName) {
      record_.footer = footer_from_metadata(values);
    }
  }

  Record finish(std::string damage) && {
    if (!has_header_)
      fail(file_, "not a record of Tether, or truncated before the end of its header" +
                      (damage.empty() ? "" : " (" + damage + ")"));
    record_.damage = std::move(damage);
    for (const auto& [id, channel] : channels_)
      if (channel.unloaded > 0) record_.unloaded[channel.topic] += channel.unloaded;
    return std::move(record_);
  }

 private:
  using Appender = void (RecordBuilder::*)(SimTime, std::string_view);

  struct Channel {
    std::string topic;
    Appender append = nullptr;
    std::uint64_t next_sequence = 0;
    std::uint64_t unloaded = 0;
  };

  void count(std::uint32_t sequence, SimTime at, Channel& channel) {
    if (sequence != channel.next_sequence && record_.miscounts.size() < kMaxMiscounts)
      record_.miscounts.push_back({channel.topic, at, channel.next_sequence, sequence});
    channel.next_sequence = std::uint64_t{sequence} + 1;
  }

  Appender appender(std::string_view schema) const {
    Appender found = nullptr;
    const auto take = [&]<class Kind>(const KindInfo<Kind>& kind) {
      if (kind.schema.name != schema) return;
      const bool is_wanted = options_.images || !kIsImage<Kind>;
      found = is_wanted ? &RecordBuilder::append<Kind> : &RecordBuilder::skip;
    };
    std::apply([&](const auto&... kinds) { (take(kinds), ...); }, kKinds);
    return found;
  }

  template <class Kind>
  void append(SimTime at, std::string_view json) {
    messages_of<Kind>(record_).push_back({at, order_, from_json<Kind>(json)});
  }
  void skip(SimTime, std::string_view) {}

  void read_header(const StringMap& values) {
    if (schema_version(values) > kSchemaVersion)
      fail(file_, "written by a newer version of Tether (record schema " +
                      std::to_string(schema_version(values)) + ", this version reads up to " +
                      std::to_string(kSchemaVersion) + "). Read it with that version");
    record_.header = header_from_metadata(values);
    has_header_ = true;
  }

  const std::filesystem::path& file_;
  const ReadOptions& options_;
  Record record_;
  bool has_header_ = false;
  std::uint64_t order_ = 0;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

SimTime last_time(const Record& record) {
  SimTime last{};
  const auto see = [&](const auto& messages) {
    for (const auto& logged : messages) last = std::max(last, logged.at);
  };
  see(record.interactions);
  see(record.commands);
  see(record.ground_truth);
  see(record.annotations);
  see(record.stops);
  see(record.contacts);
  see(record.batteries);
  see(record.radio);
  return last;
}

std::string describe_damage(const Record& record) {
  if (record.footer) return record.damage;
  return "truncated at ST " + std::to_string(to_seconds(last_time(record))) + " s, after " +
         std::to_string(record.interactions.size()) + " interactions" +
         (record.damage.empty() ? "" : "; " + record.damage);
}

Record read_record(const std::filesystem::path& file, const ReadOptions& options) {
  RecordBuilder builder(file, options);
  std::string damage = read_mcap(file, builder);
  return std::move(builder).finish(std::move(damage));
}

}  // namespace tether::record
