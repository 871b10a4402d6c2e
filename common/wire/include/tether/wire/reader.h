#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include <tether/base/result.h>
#include <tether/wire/values.h>

/// Frames of any bytes to messages.
namespace tether::wire {

/// What is the same for all tables of a frame: its bytes, and what is wrong with it.
class FrameReader {
 public:
  /// @param frame  8-byte aligned  @param max_tables  above what any valid message has
  FrameReader(std::span<const std::uint8_t> frame, std::uint32_t max_tables)
      : frame_(frame), verifier_(frame.data(), frame.size(), kMaxDepth, max_tables) {}

  bool is_good() const { return !is_corrupt_ && complaint_.empty(); }
  /// Empty: the frame is corrupt, if it is not good.
  const std::string& complaint() const { return complaint_; }

 private:
  friend class TableReader;

  /// Tables in tables of any valid message are fewer.
  static constexpr std::uint32_t kMaxDepth = 8;

  std::span<const std::uint8_t> frame_;
  flatbuffers::Verifier verifier_;
  bool is_corrupt_ = false;
  std::string complaint_;
};

/// Reads one table: `fields` asks it for each field, which is within the frame, or the frame is
/// corrupt. After the first fault, it leaves the rest as it is.
class TableReader {
 public:
  TableReader(FrameReader& frame, std::size_t table) : frame_(frame), table_(table) {
    const std::uint8_t* const start = bytes() + table;
    if (!frame.verifier_.VerifyTableStart(start)) {
      corrupt();
      return;
    }
    vtable_ = table - static_cast<std::size_t>(read_as<std::int32_t>(table));
    vtable_bytes_ = read_as<std::uint16_t>(vtable_);
  }
  ~TableReader() { frame_.verifier_.EndTable(); }
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  template <class... T>
  void here(const T&...) {}
  template <class... T>
  void require(const T&...) {}

  template <Scalar T, class... Options>
  void operator()(const char*, T& value, const Options&... options) {
    value = from_number<T>(number(default_of<T>(options...)));
  }
  /// An index. The FieldChecker refuses those that are too large, as the negative ones become.
  template <class... Options>
  void operator()(const char*, std::optional<std::uint32_t>& index, const Options&...) {
    const auto found = number(std::int32_t{-1});
    index.reset();
    if (found != -1) index = static_cast<std::uint32_t>(found);
  }
  template <Struct T, class... Options>
  void operator()(const char*, T& value, const Options&...) {
    const std::size_t at = next_field();
    if (at == 0 || !frame_.verifier_.Verify(at, sizeof(Packed<T>))) return corrupt();
    unpack(bytes() + at, value);
  }
  template <Table T, class... Options>
  void operator()(const char*, T& value, const Options&...) {
    if (const std::size_t at = child(Presence::kRequired)) read_table(at, value);
  }
  template <class... Options>
  void operator()(const char*, std::string& text, const Options&...) {
    if (const std::size_t at = child(presence<Options...>())) read_text(at, text);
  }
  template <class T, class... Options>
  void operator()(const char* name, std::vector<T>& items, const Options&... options) {
    if (const std::size_t at = child(presence<Options...>()))
      read_items(name, at, items, find<AtMost>(options...));
  }
  template <Union T, class... Options>
  void operator()(const char* name, T& value, const Options&...) {
    const auto kind = number(std::uint8_t{0});
    if (const std::size_t at = child(Presence::kRequired)) read_union(name, kind, at, value);
  }
  template <class T, class... Options>
  void operator()(const char* name, std::optional<T>& value, const Options&...) {
    value.reset();
    if constexpr (Union<T>) {
      const auto kind = number(std::uint8_t{0});
      const std::size_t at = child(Presence::kOptional);
      if (kind == 0 || !frame_.is_good()) return;
      if (at == 0) return corrupt();
      read_union(name, kind, at, value.emplace());
    } else {
      if (const std::size_t at = child(Presence::kOptional)) read_table(at, value.emplace());
    }
  }

 private:
  enum class Presence { kRequired, kOptional };
  template <class... Options>
  static constexpr Presence presence() {
    return kHas<OmitEmpty, Options...> ? Presence::kOptional : Presence::kRequired;
  }

  const std::uint8_t* bytes() const { return frame_.frame_.data(); }
  void corrupt() { frame_.is_corrupt_ = true; }
  template <class T>
  T read_as(std::size_t at) const {
    T value;
    std::memcpy(&value, bytes() + at, sizeof value);
    return value;
  }

  /// The place of the next field's content; 0: it is absent.
  std::size_t next_field() {
    const std::size_t entry = flatbuffers::FieldIndexToOffset(field_++);
    if (!frame_.is_good() || entry + 2 > vtable_bytes_) return 0;
    const auto offset = read_as<std::uint16_t>(vtable_ + entry);
    return offset == 0 ? 0 : table_ + offset;
  }
  template <class T>
  T number(T absent) {
    const std::size_t at = next_field();
    if (at == 0) return absent;
    if (frame_.verifier_.Verify(at, sizeof(T))) return read_as<T>(at);
    corrupt();
    return absent;
  }
  /// Where the next field leads; 0: nowhere.
  std::size_t child(Presence presence) {
    const std::size_t at = next_field();
    if (at == 0) {
      if (presence == Presence::kRequired) corrupt();
      return 0;
    }
    return followed(at);
  }
  std::size_t followed(std::size_t at) {
    const std::size_t offset = frame_.verifier_.VerifyOffset(at);
    if (offset == 0) corrupt();
    return offset == 0 ? 0 : at + offset;
  }

  template <class T>
  void read_table(std::size_t at, T& value) {
    TableReader table(frame_, at);
    if (frame_.is_good()) fields(table, value);
  }
  void read_text(std::size_t at, std::string& text) {
    const auto* const found = reinterpret_cast<const flatbuffers::String*>(bytes() + at);
    if (!frame_.verifier_.VerifyString(found)) return corrupt();
    text.assign(found->c_str(), found->size());
  }
  template <class T>
  void read_items(const char* name, std::size_t at, std::vector<T>& items,
                  const std::optional<AtMost>& limit) {
    constexpr std::size_t kItemBytes = [] {
      if constexpr (Scalar<T>) {
        return sizeof(T);
      } else if constexpr (Struct<T>) {
        return sizeof(Packed<T>);
      } else {
        return sizeof(flatbuffers::uoffset_t);
      }
    }();
    std::size_t end = 0;
    if (!frame_.verifier_.VerifyVectorOrString(bytes() + at, kItemBytes, &end)) return corrupt();
    const std::size_t begin = at + sizeof(flatbuffers::uoffset_t);
    const std::size_t count = (end - begin) / kItemBytes;
    if (limit && count > limit->count) {
      frame_.complaint_ = std::string(name) + " " + std::string(limit->complaint);
      return;
    }
    items.resize(count);
    if constexpr (Scalar<T>) {
      if (count > 0) std::memcpy(items.data(), bytes() + begin, count * kItemBytes);
    } else {
      for (std::size_t i = 0; i < count && frame_.is_good(); ++i) {
        const std::size_t place = begin + i * kItemBytes;
        if constexpr (Struct<T>) {
          unpack(bytes() + place, items[i]);
        } else if (const std::size_t item = followed(place)) {
          if constexpr (std::is_same_v<T, std::string>) {
            read_text(item, items[i]);
          } else {
            read_table(item, items[i]);
          }
        }
      }
    }
  }
  template <class... Tables>
  void read_union(const char* name, std::uint8_t kind, std::size_t at,
                  std::variant<Tables...>& value) {
    std::uint8_t tried = 0;
    const auto is_read =
        ((++tried == kind && (read_table(at, value.template emplace<Tables>()), true)) || ...);
    if (!is_read) frame_.complaint_ = std::string(name) + " of unknown kind";
  }

  FrameReader& frame_;
  std::size_t table_;
  std::size_t vtable_ = 0;
  std::uint16_t vtable_bytes_ = 0;
  flatbuffers::voffset_t field_ = 0;
};

/// Reads the message that is the root of a size-prefixed frame of any bytes. Fails with kProtocol;
/// never reads outside of the frame. The values may be any: a FieldChecker is next.
/// @param what  whose frames these are: "a Tether message"
template <Table T>
Result<T> read_frame(std::span<const std::uint8_t> frame, const char* identifier,
                     std::uint32_t max_tables, const char* what) {
  const auto refused = [](std::string why) {
    return Failure{Failure::Kind::kProtocol, "bad message: " + std::move(why)};
  };
  const auto corrupt = [&] { return refused(std::string("not ") + what + ", or corrupt"); };
  // Length, root offset, identifier, and the least root table.
  constexpr std::size_t kMinFrameBytes = 16;
  if (frame.size() < kMinFrameBytes) return refused("frame too short");
  // The library reads lengths and offsets in place, which must be aligned.
  if (reinterpret_cast<std::uintptr_t>(frame.data()) % 8 != 0) {
    std::vector<std::uint64_t> aligned((frame.size() + 7) / 8);
    std::memcpy(aligned.data(), frame.data(), frame.size());
    return read_frame<T>({reinterpret_cast<const std::uint8_t*>(aligned.data()), frame.size()},
                         identifier, max_tables, what);
  }
  constexpr std::size_t kPrefix = sizeof(flatbuffers::uoffset_t);
  std::uint32_t length = 0, root = 0;
  std::memcpy(&length, frame.data(), sizeof length);
  std::memcpy(&root, frame.data() + kPrefix, sizeof root);
  if (length != frame.size() - kPrefix || root >= length ||
      std::memcmp(frame.data() + 2 * kPrefix, identifier, 4) != 0)
    return corrupt();
  FrameReader reader(frame, max_tables);
  T message{};
  {
    TableReader table(reader, kPrefix + root);
    if (reader.is_good()) fields(table, message);
  }
  if (reader.is_good()) return message;
  return reader.complaint().empty() ? corrupt() : refused(reader.complaint());
}

}  // namespace tether::wire
