#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include <tether/wire/fields.h>
#include <tether/wire/values.h>

/// Messages to frames.
namespace tether::wire {

/// Builds frames, one after the other, in one buffer. Not thread-safe.
class FrameWriter {
 public:
  using Offset = flatbuffers::Offset<void>;

  /// A size-prefixed frame with a message as its root. Without the bytes that are Apart, for which
  /// it has room; valid until the next call.
  /// @param identifier  four characters
  template <Table T>
  FramePieces write(const T& message, const char* identifier);

  /// The frame of the last write() in one piece, with the bytes that are Apart.
  std::span<const std::uint8_t> whole() {
    if (!apart_.empty()) std::memcpy(&frame()[apart_begin()], apart_.data(), apart_.size());
    return frame();
  }

 private:
  friend class TableWriter;

  std::span<std::uint8_t> frame() { return {builder_.GetBufferPointer(), builder_.GetSize()}; }
  std::size_t apart_begin() {
    return frame().size() - apart_end_distance_ + sizeof(flatbuffers::uoffset_t);
  }

  flatbuffers::FlatBufferBuilder builder_;
  std::span<const std::uint8_t> apart_;
  std::size_t apart_end_distance_ = 0;  ///< from the vector's length to the end of the buffer
  std::vector<Offset> items_;           ///< of the lists that are being written
};

/// Writes one table: `fields` hands it each field, children first, and end() lays out the table as
/// the code that flatc generates does: larger numbers first, later fields first.
class TableWriter {
 public:
  explicit TableWriter(FrameWriter& frame) : frame_(frame), builder_(frame.builder_) {}

  template <class... T>
  void here(const T&...) {}
  template <class... T>
  void require(const T&...) {}

  template <Scalar T, class... Options>
  void operator()(const char*, const T& value, const Options&... options) {
    add_number(to_number(value), default_of<T>(options...));
  }
  /// An index.
  template <class... Options>
  void operator()(const char*, const std::optional<std::uint32_t>& index, const Options&...) {
    add_number(index ? static_cast<std::int32_t>(*index) : -1, -1);
  }
  template <Struct T, class... Options>
  void operator()(const char*, const T& value, const Options&...) {
    // In the layout, a struct counts as large as an offset.
    Slot& slot = next(sizeof(flatbuffers::uoffset_t));
    slot.content.bytes = {};
    pack(value, slot.content.bytes.data());
    slot.place = [](flatbuffers::FlatBufferBuilder& builder, const Slot& of) {
      Packed<T> packed;
      std::memcpy(&packed, of.content.bytes.data(), sizeof packed);
      builder.AddStruct(of.field, &packed);
    };
  }
  template <Table T, class... Options>
  void operator()(const char*, const T& value, const Options&...) {
    add_child(write(value));
  }
  template <class... Options>
  void operator()(const char*, const std::string& text, const Options&...) {
    const bool is_left_out = kHas<OmitEmpty, Options...> && text.empty();
    add_child(is_left_out ? 0 : builder_.CreateString(text).o);
  }
  template <class T, class... Options>
  void operator()(const char*, const std::vector<T>& items, const Options&...) {
    const bool is_left_out = kHas<OmitEmpty, Options...> && items.empty();
    if constexpr (kHas<Apart, Options...>) {
      // Room that nobody touches. As the first of all children it lies at the end of the buffer,
      // which grows downwards: a frame is one piece before it and, at most, padding after.
      std::uint8_t* room = nullptr;
      frame_.apart_ = items;
      frame_.apart_end_distance_ =
          builder_.CreateUninitializedVector<std::uint8_t>(items.size(), &room).o;
      add_child(static_cast<flatbuffers::uoffset_t>(frame_.apart_end_distance_));
    } else {
      add_child(is_left_out ? 0 : write(items));
    }
  }
  template <Union T, class... Options>
  void operator()(const char*, const T& value, const Options&... options) {
    add_union(&value, find<After>(options...).value_or(After{}).members);
  }
  template <class T, class... Options>
  void operator()(const char*, const std::optional<T>& value, const Options&...) {
    if constexpr (Union<T>) {
      add_union(value ? &*value : nullptr, 0);
    } else {
      add_child(value ? write(*value) : 0);
    }
  }

  flatbuffers::uoffset_t end() {
    const flatbuffers::uoffset_t start = builder_.StartTable();
    for (std::size_t size = 8; size > 0; size /= 2)
      for (std::size_t i = count_; i > 0; --i)
        if (slots_[i - 1].size == size) slots_[i - 1].place(builder_, slots_[i - 1]);
    return builder_.EndTable(start);
  }

 private:
  /// A field that waits for its place in the table.
  struct Slot {
    union Content {
      std::uint64_t number;
      flatbuffers::uoffset_t child;
      std::array<std::uint8_t, 56> bytes;
    };
    flatbuffers::voffset_t field;
    std::size_t size;
    void (*place)(flatbuffers::FlatBufferBuilder&, const Slot&);
    Content content;
  };
  static constexpr std::size_t kMaxFields = 24;  ///< of a table that are not absent

  template <Table T>
  flatbuffers::uoffset_t write(const T& value) {
    TableWriter table(frame_);
    fields(table, value);
    return table.end();
  }

  template <class T>
  flatbuffers::uoffset_t write(const std::vector<T>& items) {
    if constexpr (Scalar<T>) {
      return builder_.CreateVector(items).o;
    } else if constexpr (Struct<T>) {
      Packed<T>* room = nullptr;
      const auto at = builder_.CreateUninitializedVectorOfStructs<Packed<T>>(items.size(), &room);
      for (std::size_t i = 0; i < items.size(); ++i) {
        Packed<T> packed{};
        pack(items[i], packed.bytes);
        std::memcpy(room + i, &packed, sizeof packed);
      }
      return at.o;
    } else {
      const std::size_t begin = frame_.items_.size();
      for (const T& item : items) {
        if constexpr (std::is_same_v<T, std::string>) {
          frame_.items_.emplace_back(builder_.CreateString(item).o);
        } else {
          frame_.items_.emplace_back(write(item));
        }
      }
      const auto at = builder_.CreateVector(frame_.items_.data() + begin, items.size());
      frame_.items_.resize(begin);
      return at.o;
    }
  }

  Slot& next(std::size_t size) {
    Slot& slot = slots_.at(count_++);
    slot.field = flatbuffers::FieldIndexToOffset(next_field_++);
    slot.size = size;
    return slot;
  }
  template <class T>
  void add_number(T number, T absent) {
    if (number == absent) {
      ++next_field_;
      return;
    }
    Slot& slot = next(sizeof number);
    std::memcpy(&slot.content.number, &number, sizeof number);
    slot.place = [](flatbuffers::FlatBufferBuilder& builder, const Slot& of) {
      T placed;
      std::memcpy(&placed, &of.content.number, sizeof placed);
      builder.TrackField(of.field, builder.PushElement(placed));
    };
  }
  /// @param child  0: there is none
  void add_child(flatbuffers::uoffset_t child) {
    if (child == 0) {
      ++next_field_;
      return;
    }
    Slot& slot = next(sizeof child);
    slot.content.child = child;
    slot.place = [](flatbuffers::FlatBufferBuilder& builder, const Slot& of) {
      builder.AddOffset(of.field, flatbuffers::Offset<void>(of.content.child));
    };
  }
  /// Its kind, counted from 1, and where it is.
  template <class T>
  void add_union(const T* value, std::size_t before) {
    const auto kind = static_cast<std::uint8_t>(value ? before + value->index() + 1 : 0);
    const flatbuffers::uoffset_t child =
        value ? std::visit([this](const auto& table) { return this->write(table); }, *value) : 0;
    add_number(kind, std::uint8_t{0});
    add_child(child);
  }

  FrameWriter& frame_;
  flatbuffers::FlatBufferBuilder& builder_;
  std::array<Slot, kMaxFields> slots_;
  std::size_t count_ = 0;
  flatbuffers::voffset_t next_field_ = 0;
};

template <Table T>
FramePieces FrameWriter::write(const T& message, const char* identifier) {
  builder_.Clear();
  apart_ = {};
  TableWriter root(*this);
  fields(root, message);
  builder_.FinishSizePrefixed(Offset(root.end()), identifier);
  if (apart_.empty()) return {frame(), {}, {}};
  const std::size_t begin = apart_begin();
  return {frame().first(begin), apart_, frame().subspan(begin + apart_.size())};
}

}  // namespace tether::wire
