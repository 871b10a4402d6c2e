#include "sha256.h"

#include <string>

#include <gtest/gtest.h>

namespace tether::mavlink {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string hex_of(const Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

// The published examples of FIPS 180-4.
TEST(Sha256, OfThePublishedExamples) {
  const std::pair<std::string, const char*> examples[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1'000'000, 'a'),
       "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}};
  for (const auto& [text, digest] : examples)
    EXPECT_EQ(hex_of(Sha256().add(bytes_of(text)).finish()), digest) << text.size();
}

TEST(Sha256, PiecesDoNotMatter) {
  const std::string text(200, 'x');
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const std::string_view part = std::string_view(text).substr(0, size);
    const Digest whole = Sha256().add(bytes_of(part)).finish();
    const Digest halves = Sha256()
                              .add(bytes_of(part.substr(0, size / 2)))
                              .add(bytes_of(part.substr(size / 2)))
                              .finish();
    EXPECT_EQ(whole, halves) << size;
  }
}

}  // namespace
}  // namespace tether::mavlink
