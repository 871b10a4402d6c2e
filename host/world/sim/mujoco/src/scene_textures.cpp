#include "scene_textures.h"

#include "meshes/named_file.h"
#include "meshes/texture_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <tether/os/text_file.h>
#include <tether/sim/world_parts.h>

namespace tether::sim {
namespace {

// Each pixel is the mean of four.
raster::Texture halved(const raster::Texture& in) {
  raster::Texture out{std::max(1, in.width_px / 2), std::max(1, in.height_px / 2), {}};
  out.rgba.reserve(4 * static_cast<std::size_t>(out.width_px) *
                   static_cast<std::size_t>(out.height_px));
  const auto pixel = [&](int x, int y) {
    const auto column = static_cast<std::size_t>(std::min(x, in.width_px - 1));
    const auto row = static_cast<std::size_t>(std::min(y, in.height_px - 1));
    return in.rgba.data() + 4 * (row * static_cast<std::size_t>(in.width_px) + column);
  };
  for (int y = 0; y < out.height_px; ++y)
    for (int x = 0; x < out.width_px; ++x) {
      const std::uint8_t* const of[] = {pixel(2 * x, 2 * y), pixel(2 * x + 1, 2 * y),
                                        pixel(2 * x, 2 * y + 1), pixel(2 * x + 1, 2 * y + 1)};
      for (std::size_t c = 0; c < 4; ++c)
        out.rgba.push_back(
            static_cast<std::uint8_t>((of[0][c] + of[1][c] + of[2][c] + of[3][c] + 2) / 4));
    }
  return out;
}

using Numbers = std::vector<std::optional<std::size_t>>;

// The textures that can be read, and of each source, which of them it is; none: it cannot be read.
struct ReadTextures {
  std::vector<raster::Texture> textures;
  Numbers numbers;
};

class TextureReader {
 public:
  TextureReader(bool is_strict, const WarningSink& warn) : is_strict_(is_strict), warn_(warn) {}

  void read(const TextureSource& source) {
    std::optional<std::size_t> number = read_.textures.size();
    try {
      add(source.picture ? *source.picture : read_named(source.named_at, [&] {
        return load_texture(source.file, warn_);
      }));
    } catch (const Error& error) {
      if (is_strict_ || error.code() != ErrorCode::kBadFile) throw;
      warn_({Consequence::kLooksDifferent,
             {source.file.string()},
             "texture",
             std::string("cannot be used, and the colours are: ") + error.what(),
             true});
      number.reset();
    }
    read_.numbers.push_back(number);
  }

  ReadTextures take() { return std::move(read_); }

 private:
  // Where all of them have more pixels than the renderer takes, the largest ones are halved.
  void add(raster::Texture texture) {
    texels_ += texture.rgba.size() / 4;
    read_.textures.push_back(std::move(texture));
    while (texels_ > raster::kMaxTexels) {
      const auto size = [](const raster::Texture& t) { return t.rgba.size(); };
      raster::Texture& largest = *std::ranges::max_element(read_.textures, {}, size);
      texels_ -= largest.rgba.size() / 4;
      largest = halved(largest);
      texels_ += largest.rgba.size() / 4;
      if (!std::exchange(has_halved_, true))
        warn_({Consequence::kLooksDifferent,
               {},
               "textures",
               "have more than 67,108,864 pixels together: the largest are drawn at half their "
               "size"});
    }
  }

  bool is_strict_;
  const WarningSink& warn_;
  ReadTextures read_;
  std::size_t texels_ = 0;
  bool has_halved_ = false;
};

// None: a file changed so shortly ago that it can change again without another time.
std::optional<std::string> key_of(const std::vector<TextureSource>& sources, bool is_strict) {
  ByteWriter key;
  const std::string what = "textures";
  key(what, identity_of_program(), is_strict);
  for (const TextureSource& source : sources) {
    key(source.file, source.named_at);
    if (source.picture) {
      const auto& [width, height, rgba] = *source.picture;
      key(width, height, os::digest_of({reinterpret_cast<const char*>(rgba.data()), rgba.size()}));
    } else {
      const FileState state = state_of(source.file);
      if (!is_older(state, kFileTick)) return std::nullopt;
      key(state);
    }
  }
  return key.take();
}

// What the cache has of the sources: the parts of an entry are the numbers with the warnings, and
// the arrays of the set.
std::optional<raster::TextureSet> find(const FileCache& cache, const std::string& key,
                                       Numbers& numbers, std::vector<Warning>& warnings) try {
  const FileCache::Parts kept = cache.find(key);
  if (kept == nullptr) return std::nullopt;
  ByteReader(kept->front())(numbers, warnings);
  return raster::TextureSet(std::span(*kept).subspan(1), kept);
} catch (const std::logic_error&) {  // of another layout
  return std::nullopt;
}

void keep(const FileCache& cache, const std::string& key, const Numbers& numbers,
          const std::vector<Warning>& warnings, const raster::TextureSet& set) {
  ByteWriter out;
  out(numbers, warnings);
  const std::string head = out.take();
  std::vector<std::string_view> parts{head};
  for (const std::string_view array : set.arrays()) parts.push_back(array);
  cache.keep(key, parts, parts.size() - 1);  // pixels may be any
}

}  // namespace

void add_textures(const std::vector<TextureSource>& sources, bool is_strict,
                  const WarningSink& warn, const std::optional<FileCache>& cache,
                  raster::SceneParts& parts) {
  if (sources.empty()) return;
  Numbers numbers;
  std::vector<Warning> warnings;
  const std::optional<std::string> key = cache ? key_of(sources, is_strict) : std::nullopt;
  if (key) parts.texture_set = find(*cache, *key, numbers, warnings);
  if (!parts.texture_set) {
    const WarningSink collect = [&](const Warning& warning) { warnings.push_back(warning); };
    warnings.clear();
    TextureReader reader(is_strict, collect);
    for (const TextureSource& source : sources) reader.read(source);
    ReadTextures read = reader.take();
    numbers = std::move(read.numbers);
    parts.textures = std::move(read.textures);
    if (key) {
      parts.texture_set.emplace(parts.textures);
      parts.textures.clear();
      keep(*cache, *key, numbers, warnings, *parts.texture_set);
    }
  }
  for (const Warning& warning : warnings) warn(warning);
  for (raster::Material& material : parts.materials)
    if (material.texture) material.texture = numbers.at(*material.texture);
}

}  // namespace tether::sim
