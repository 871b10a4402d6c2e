#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace tether::fuzz {

/// An input that grows piece by piece and is then written to `<folder>/<target>/<name>`.
class SeedFile {
 public:
  SeedFile& add(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  SeedFile& add(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  SeedFile& byte(unsigned value) {
    bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  void write(const std::filesystem::path& folder, const std::string& target,
             const std::string& name) const {
    std::filesystem::create_directories(folder / target);
    std::ofstream out(folder / target / name, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes_.data()),
              static_cast<std::streamsize>(bytes_.size()));
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace tether::fuzz
