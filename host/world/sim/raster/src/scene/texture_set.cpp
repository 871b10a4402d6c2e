#include "scene/prepared_scene.h"

#include <stdexcept>
#include <string>

#include <tether/base/error.h>
#include <tether/sim_raster/scene.h>

namespace tether::raster {
namespace {

constexpr std::uint8_t kOpaqueByte = 254;

void require_usable(bool condition, const std::string& subject, const char* what) {
  if (!condition) throw Error(ErrorCode::kBadFile, subject + ": " + what).about(subject);
}

void check(const Texture& texture, const std::string& name) {
  const auto is_size = [](int px) { return px >= 1 && px <= kMaxTextureSize_px; };
  require_usable(is_size(texture.width_px) && is_size(texture.height_px), name,
                 "its size is not 1 to 8192 pixels each way");
  require_usable(texture.rgba.size() == std::size_t{4} *
                                            static_cast<std::size_t>(texture.width_px) *
                                            static_cast<std::size_t>(texture.height_px),
                 name, "not four bytes for each pixel");
}

void check_textures(const std::vector<Texture>& textures) {
  std::size_t texels = 0;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    check(textures[i], "texture " + std::to_string(i));
    texels += textures[i].rgba.size() / 4;
  }
  require_usable(texels <= kMaxTexels, "scene", "textures of more than 67,108,864 pixels");
}

bool is_transparent(const Texture& texture) {
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) {
    if (texture.rgba[i] < kOpaqueByte) return true;
  }
  return false;
}

template <class T>
std::string_view bytes_of(std::span<const T> items) {
  return {reinterpret_cast<const char*>(items.data()), items.size_bytes()};
}

template <class T>
std::span<const T> items_of(std::string_view bytes) {
  if (bytes.size() % sizeof(T) != 0) throw std::invalid_argument("not an array of textures");
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

}  // namespace

TextureSet::TextureSet(const std::vector<Texture>& textures) {
  check_textures(textures);
  auto out = std::make_shared<PreparedTextures>();
  const Texture white{1, 1, {255, 255, 255, 255}};
  // Else the vector would be copied as often as it grows: there may be 700 MB.
  std::size_t texels = 2 * texels_of(white);
  for (const Texture& texture : textures) texels += texels_of(texture);
  out->texels.reserve(texels);
  add_texture(white, *out);
  for (const Texture& texture : textures) {
    const auto first = static_cast<std::int32_t>(out->levels.size());
    const std::int32_t levels = add_texture(texture, *out);
    out->rows.push_back(
        {texture.width_px, texture.height_px, first, levels, is_transparent(texture) ? 1 : 0});
  }
  add_texture(white, *out);
  out->all_texels = out->texels;
  prepared_ = std::move(out);
}

std::vector<std::string_view> TextureSet::arrays() const {
  return {bytes_of(std::span(prepared_->rows)), bytes_of(std::span(prepared_->levels)),
          bytes_of(prepared_->all_texels)};
}

TextureSet::TextureSet(std::span<const std::string_view> arrays,
                       std::shared_ptr<const void> owner) {
  if (arrays.size() != 3) throw std::invalid_argument("not the arrays of textures");
  auto out = std::make_shared<PreparedTextures>();
  const auto rows = items_of<TextureRow>(arrays[0]);
  const auto levels = items_of<LevelRow>(arrays[1]);
  out->rows.assign(rows.begin(), rows.end());
  out->levels.assign(levels.begin(), levels.end());
  out->all_texels = items_of<TexelPair>(arrays[2]);
  out->owner = std::move(owner);
  prepared_ = std::move(out);
}

std::size_t TextureSet::size() const {
  return prepared_->rows.size();
}

}  // namespace tether::raster
