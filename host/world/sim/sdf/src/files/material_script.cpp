// A script consists of blocks with a header and braces; in them, each line is an attribute.

#include "files/material_script.h"

#include "files/sdf_numbers.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

namespace tether::sim {
namespace {

using uav::Vec3;
using Words = std::vector<std::string>;

std::string without_comments(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = std::string_view(text).substr(i);
    if (rest.starts_with("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string::npos ? text.size() : end + 2;
    } else {
      out += text[i++];
    }
  }
  return out;
}

// Words, without quotes around them.
Words split(const std::string& line) {
  Words words;
  std::istringstream in(line);
  for (std::string word; in >> std::ws && !in.eof();) {
    if (in.peek() == '"') {
      in.get();
      std::getline(in, word, '"');
    } else if (!(in >> word)) {
      break;
    }
    words.push_back(word);
  }
  return words;
}

std::vector<double> numbers_from(const Words& words, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = parse_numbers(words[i]);
    if (!number || number->size() != 1 || !std::isfinite(number->front())) break;
    numbers.push_back(number->front());
  }
  return numbers;
}

// What a pass says first counts.
void say(const std::vector<double>& numbers, std::size_t first, std::optional<Vec3>& colour) {
  if (numbers.size() < first + 3 || colour) return;
  const auto share = [&](std::size_t i) { return std::clamp(numbers[first + i], 0.0, 1.0); };
  colour = Vec3{share(0), share(1), share(2)};
}

class Script {
 public:
  explicit Script(ScriptMaterials& materials) : materials_(materials) {}

  void read(const std::string& text) {
    std::istringstream lines(without_comments(text));
    for (std::string line; std::getline(lines, line);) {
      std::string part;
      for (const char c : line) {
        if (c != '{' && c != '}') {
          part += c;
          continue;
        }
        take(part);
        if (c == '{') open();
        if (c == '}') close();
      }
      take(part);
    }
  }

 private:
  // A line may turn out to be a header.
  void take(std::string& line) {
    Words words = split(line);
    line.clear();
    if (words.empty()) return;
    if (is_read()) read_attribute(words);
    last_ = std::move(words);
  }

  void open() {
    const std::string kind = last_.empty() ? "" : last_.front();
    if (blocks_.empty() && kind == "material" && last_.size() > 1) begin_material();
    if (blocks_.size() == 1 && kind == "technique") ++techniques_;
    blocks_.push_back(kind);
    last_.clear();
  }

  void close() {
    last_.clear();
    if (blocks_.empty()) return;
    if (blocks_.size() == 1 && blocks_[0] == "material" && !name_.empty()) end_material();
    blocks_.pop_back();
  }

  void begin_material() {
    name_ = last_[1];
    techniques_ = 0;
    said_ = base_ = {};
    blends_ = is_unlit_ = false;
    const auto colon = std::ranges::find(last_, ":");
    if (colon == last_.end() || colon + 1 == last_.end()) return;
    const auto base = materials_.find(*(colon + 1));
    const ScriptMaterial* const own = gazebo_material(*(colon + 1));
    if (base != materials_.end()) {
      base_ = base->second;
    } else if (own != nullptr) {
      base_ = *own;
    }
  }

  void end_material() {
    if (is_unlit_) {
      said_.emissive_rgb = said_.diffuse_rgb.value_or(Vec3{1.0, 1.0, 1.0});
      said_.diffuse_rgb = said_.ambient_rgb = Vec3{};
    }
    if (!blends_) said_.alpha.reset();
    ScriptMaterial& out = materials_[name_];
    out = base_;
    for (const auto colour : {&ScriptMaterial::ambient_rgb, &ScriptMaterial::diffuse_rgb,
                              &ScriptMaterial::specular_rgb, &ScriptMaterial::emissive_rgb})
      if (said_.*colour) out.*colour = said_.*colour;
    if (said_.alpha) out.alpha = said_.alpha;
    if (!said_.texture.empty()) {
      out.texture = said_.texture;
      out.texture_scale_x = said_.texture_scale_x;
      out.texture_scale_y = said_.texture_scale_y;
    }
    out.is_double_sided = base_.is_double_sided || said_.is_double_sided;
    name_.clear();
  }

  // In a pass of the first technique of a material, or in its texture.
  bool is_read() const {
    return techniques_ == 1 && blocks_.size() >= 3 && blocks_.size() <= 4 &&
           blocks_[0] == "material" && blocks_[2] == "pass" &&
           (blocks_.size() == 3 || blocks_[3] == "texture_unit");
  }

  void read_attribute(const Words& words) {
    const std::string& key = words[0];
    const std::string what = words.size() > 1 ? words[1] : "";
    const std::vector<double> numbers = numbers_from(words, 1);
    if (blocks_.size() == 4) {
      read_texture(words, numbers);
    } else if (key == "diffuse") {
      if (!said_.diffuse_rgb && numbers.size() > 3) said_.alpha = std::clamp(numbers[3], 0.0, 1.0);
      say(numbers, 0, said_.diffuse_rgb);
    } else if (key == "ambient") {
      say(numbers, 0, said_.ambient_rgb);
    } else if (key == "specular") {
      say(numbers, 0, said_.specular_rgb);
    } else if (key == "emissive") {
      say(numbers, 0, said_.emissive_rgb);
    } else if (key == "scene_blend") {
      blends_ = blends_ || what == "alpha_blend";
    } else if (key == "lighting") {
      is_unlit_ = is_unlit_ || what == "off";
    } else if (key == "cull_hardware") {
      said_.is_double_sided = said_.is_double_sided || what == "none";
    }
  }

  void read_texture(const Words& words, const std::vector<double>& numbers) {
    if (words[0] == "texture" && words.size() > 1 && said_.texture.empty())
      said_.texture = words[1];
    if (words[0] == "scale" && numbers.size() > 1 && numbers[0] > 1e-6 && numbers[1] > 1e-6) {
      said_.texture_scale_x = numbers[0];
      said_.texture_scale_y = numbers[1];
    }
    // "…_op_ex source1 src_manual src_current" and a value: instead of what a picture has.
    const bool is_manual = words.size() > 4 && words[2] == "src_manual";
    const std::vector<double> values = is_manual ? numbers_from(words, 4) : std::vector<double>{};
    if (words[0] == "colour_op_ex") say(values, 0, said_.diffuse_rgb);
    if (words[0] == "alpha_op_ex" && !values.empty()) said_.alpha = std::clamp(values[0], 0.0, 1.0);
  }

  ScriptMaterials& materials_;
  std::vector<std::string> blocks_;
  Words last_;
  std::string name_;  // of the open material
  int techniques_ = 0;
  ScriptMaterial base_, said_;
  bool blends_ = false;
  bool is_unlit_ = false;
};

constexpr Vec3 grey(double value) {
  return {value, value, value};
}

struct Named {
  const char* name;
  Vec3 ambient, diffuse, specular, emissive;
  double alpha = 1.0;
  const char* texture = "";
};
constexpr Vec3 kRoad_ambient = grey(0.04), kRoad = grey(0.33), kStreet{0.38, 0.36, 0.34},
               kPaving{0.47, 0.47, 0.42};

/// Without "Gazebo/".
constexpr Named kGazebo[] = {
    {"Grey", grey(0.3), grey(0.7), grey(0.01), {}},
    {"Gray", grey(0.3), grey(0.7), grey(0.01), {}},
    {"DarkGrey", grey(0.175), grey(0.175), grey(0.175), {}},
    {"DarkGray", grey(0.175), grey(0.175), grey(0.175), {}},
    {"White", grey(1), grey(1), grey(0.1), {}},
    {"FlatBlack", grey(0.1), grey(0.1), grey(0.01), {}},
    {"Black", grey(0), grey(0), grey(0.1), {}},
    {"Red", {1, 0, 0}, {1, 0, 0}, grey(0.1), {}},
    {"RedBright", {0.87, 0.26, 0.07}, {0.87, 0.26, 0.07}, {0.87, 0.26, 0.07}, {}},
    {"Green", {0, 1, 0}, {0, 1, 0}, grey(0.1), {}},
    {"Blue", {0, 0, 1}, {0, 0, 1}, grey(0.1), {}},
    {"SkyBlue", {0.13, 0.44, 0.7}, {0, 0, 1}, grey(0.1), {}},
    {"Yellow", {1, 1, 0}, {1, 1, 0}, {}, {}},
    {"ZincYellow",
     {0.9725, 0.9529, 0.2078},
     {0.9725, 0.9529, 0.2078},
     {0.9725, 0.9529, 0.2078},
     {}},
    {"DarkYellow", {0.7, 0.7, 0}, {0.7, 0.7, 0}, {}, {}},
    {"Purple", {1, 0, 1}, {1, 0, 1}, grey(0.1), {}},
    {"Turquoise", {0, 1, 1}, {0, 1, 1}, grey(0.1), {}},
    {"Orange", {1, 0.5088, 0.0468}, {1, 0.5088, 0.0468}, grey(0.5), {}},
    {"Indigo", {0.33, 0, 0.5}, {0.33, 0, 0.5}, grey(0.1), {}},
    {"Gold", {0.4, 0.249, 0.021}, {0.8, 0.649, 0.121}, grey(0.4), {}},
    {"WhiteGlow", grey(1), grey(1), grey(0.1), grey(1)},
    {"RedGlow", {1, 0, 0}, {1, 0, 0}, {}, {1, 0, 0}},
    {"GreenGlow", {0, 1, 0}, {0, 1, 0}, grey(0.1), {0, 1, 0}},
    {"BlueGlow", {0, 0, 1}, {0, 0, 1}, grey(0.1), {0, 0, 1}},
    {"YellowGlow", {1, 1, 0}, {1, 1, 0}, {}, {1, 1, 0}},
    {"PurpleGlow", {1, 0, 1}, {1, 0, 1}, grey(0.1), {1, 0, 1}},
    {"TurquoiseGlow", {0, 1, 1}, {0, 1, 1}, grey(0.1), {0, 1, 1}},
    {"RedTransparent", {}, {}, {}, {1, 0, 0}, 0.5},
    {"GreenTransparent", {0, 1, 0}, {0, 1, 0}, {}, {}, 0.5},
    {"BlueTransparent", {0, 0, 1}, {0, 0, 1}, {}, {}, 0.5},
    {"GreyTransparent", grey(0.5), grey(0.5), {}, {}, 0.5},
    {"BlackTransparent", grey(0), grey(0), {}, {}, 0.5},
    {"YellowTransparent", {1, 1, 0}, {1, 1, 0}, {}, {}, 0.5},
    {"DarkMagentaTransparent", {0.6, 0, 0.6}, {0.6, 0, 0.6}, {}, {}, 0.5},
    {"OrangeTransparent", {1, 0.44, 0}, {1, 0.44, 0}, {}, {}, 0.4},
    {"BlueLaser", {0, 0, 1}, {0, 0, 1}, {}, {}, 0.4},
    {"LightOn", {0, 1, 0}, {0, 1, 0}, {}, {0, 1, 0}},
    {"LightOff", {1, 0, 0}, {1, 0, 0}, {}, {1, 0, 0}},
    {"PioneerBody", {0.5, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {}},
    {"Pioneer2Body", {0.48, 0, 0}, {0.68, 0, 0}, grey(0.5), {}},
    // These show a picture of Gazebo's. With Tether's own, or without, they have its mean colour.
    {"Wood", {0.88, 0.6, 0.33}, {0.88, 0.6, 0.33}, grey(0.2), {}, 1.0, "wood.png"},
    {"WoodPallet", {0.34, 0.25, 0.13}, {0.67, 0.49, 0.25}, {}, {}, 1.0, "planks.png"},
    {"WoodFloor", {0.33, 0.16, 0.03}, {0.67, 0.32, 0.07}, {}, {}, 1.0, "planks.png"},
    {"Bricks", {0.68, 0.47, 0.48}, {0.68, 0.47, 0.48}, grey(0.2), {}, 1.0, "brick.png"},
    {"PaintedWall", {0.95, 0.82, 0.5}, {0.95, 0.82, 0.5}, {}, {}, 1.0, "plaster.png"},
    {"CeilingTiled", grey(0.49), grey(0.97), {}, {}, 1.0, "ceiling.png"},
    {"BuildingFrame", grey(0.64), grey(0.64), {}, {}},
    {"Grass", {0.12, 0.24, 0.03}, {0.25, 0.48, 0.05}, {}, {}},
    {"Runway", grey(0.2), grey(0.4), {}, {}},
    {"Road", kRoad_ambient, kRoad, {}, {}},
    {"Primary", kRoad_ambient, kRoad, {}, {}},
    {"Motorway", kRoad_ambient, kRoad, {}, {}},
    {"Lanes_2", kRoad_ambient, kRoad, {}, {}},
    {"Lanes_6", kRoad_ambient, kRoad, {}, {}},
    {"Residential", kRoad_ambient, kStreet, {}, {}},
    {"Tertiary", kRoad_ambient, kStreet, {}, {}},
    {"Trunk", kRoad_ambient, kStreet, {}, {}},
    {"Secondary", kRoad_ambient, kStreet, {}, {}},
    {"Lane_1", kRoad_ambient, kStreet, {}, {}},
    {"Lanes_4", kRoad_ambient, kStreet, {}, {}},
    {"Steps", kRoad_ambient, kStreet, {}, {}},
    {"Pedestrian", kRoad_ambient, kPaving, {}, {}},
    {"Footway", kRoad_ambient, kPaving, {}, {}},
};

ScriptMaterials gazebo_materials() {
  ScriptMaterials materials;
  for (const Named& m : kGazebo)
    materials[std::string("Gazebo/") + m.name] = {.ambient_rgb = m.ambient,
                                                  .diffuse_rgb = m.diffuse,
                                                  .specular_rgb = m.specular,
                                                  .emissive_rgb = m.emissive,
                                                  .alpha = m.alpha,
                                                  .texture = m.texture};
  return materials;
}

}  // namespace

void read_script(const std::string& text, ScriptMaterials& materials) {
  Script(materials).read(text);
}

const ScriptMaterial* gazebo_material(const std::string& name) {
  static const ScriptMaterials materials = gazebo_materials();
  const auto found = materials.find(name);
  return found != materials.end() ? &found->second : nullptr;
}

}  // namespace tether::sim
