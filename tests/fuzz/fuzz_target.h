#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/result.h>

/// What the fuzz targets share. Each target is a LLVMFuzzerTestOneInput in a file of its own;
/// whatever it must not do ends the process, and libFuzzer keeps the input.
namespace tether::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// What must hold for every input.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "FINDING: %s\n", what.c_str());
  std::abort();
}

inline std::string text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Messages reach terminals and logs: one line, without anything that moves a cursor.
inline void require_one_line(std::string_view message) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  require(!message.empty(), "a message without words");
  require(std::none_of(message.begin(), message.end(), is_control),
          "a message of several lines, or with control characters: " + std::string(message));
}

/// What a reader of the host's makes of an input: a value, or nothing where it refuses it as it
/// should, with one of these codes. Any other exception ends the process.
template <class Read>
auto read_or_refuse(Read read, std::initializer_list<ErrorCode> codes = {ErrorCode::kBadFile})
    -> std::optional<std::invoke_result_t<Read>> {
  try {
    return read();
  } catch (const Error& error) {
    require(std::find(codes.begin(), codes.end(), error.code()) != codes.end(),
            "refused as " + std::string(name(error.code())) + ": " + error.what());
    require_one_line(error.what());
    return std::nullopt;
  }
}

/// The same of a reader that returns what is wrong.
template <class T>
const T* value_or_refused(const Result<T>& result, std::initializer_list<Failure::Kind> kinds) {
  if (result.ok()) return &*result;
  const Failure& failure = result.failure();
  require(
      std::find(kinds.begin(), kinds.end(), failure.kind) != kinds.end(),
      "failed as kind " + std::to_string(static_cast<int>(failure.kind)) + ": " + failure.message);
  require_one_line(failure.message);
  return nullptr;
}

/// Decisions, taken from the front of an input; all 0 once that is used up.
class Choices {
 public:
  explicit Choices(Bytes input) : input_(input) {}

  bool empty() const { return input_.empty(); }
  Bytes rest() const { return input_; }
  Bytes take(std::size_t count) {
    const Bytes taken = input_.first(std::min(count, input_.size()));
    input_ = input_.subspan(taken.size());
    return taken;
  }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : take(1)[0]; }
  bool coin() { return byte() % 2 == 1; }
  /// 0 to `limit` - 1.
  std::size_t below(std::size_t limit) { return byte() % limit; }
  std::uint64_t word() {
    std::uint64_t value = 0;
    for (const std::uint8_t b : take(8)) value = value << 8 | b;
    return value;
  }
  /// Of any size, small ones often; negative ones too.
  std::int64_t number() {
    const std::uint8_t size = byte();
    std::uint64_t value = 0;
    for (const std::uint8_t b : take(size % 16 % 9)) value = value << 8 | b;
    return static_cast<std::int64_t>(size >= 128 ? ~value : value);
  }
  std::string text() { return text_of(take(byte() % 32)); }

 private:
  Bytes input_;
};

/// A folder of this process alone, where an input is a file.
class InputFolder {
 public:
  InputFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("tether-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    require(static_cast<bool>(out.flush()), "cannot write " + file.string());
    return file;
  }
  std::filesystem::path write(const std::string& name, Bytes bytes) const {
    return write(name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tether::fuzz
