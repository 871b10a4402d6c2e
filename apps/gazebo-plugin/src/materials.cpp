#include "scene.h"

#include <fstream>

#include <gazebo/rendering/RTShaderSystem.hh>
#include <gazebo/rendering/ogre_gazebo.h>
#include <gazebo/rendering/rendering.hh>

#include <tether/base/error.h>
#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

using sim::protocol::VisualMaterial;

constexpr float kShininess = 32.0F;

Ogre::ColourValue colour(const uav::Vec3& rgb) {
  return Ogre::ColourValue(static_cast<float>(rgb.x), static_cast<float>(rgb.y),
                           static_cast<float>(rgb.z));
}

std::string name_of(const VisualMaterial& wanted) {
  return wanted.model + "::" + wanted.link + "::" + wanted.visual;
}

void load_texture(const std::string& file) {
  if (Ogre::TextureManager::getSingleton().resourceExists(file)) return;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(ErrorCode::kSetup, file + ": texture cannot be read");
  Ogre::DataStreamPtr stream(OGRE_NEW Ogre::FileStreamDataStream(file, &in, false));
  Ogre::Image image;
  try {
    image.load(stream, "png");
  } catch (const Ogre::Exception&) {
    throw Error(ErrorCode::kSetup, file + ": texture is not a PNG file");
  }
  Ogre::TextureManager::getSingleton().loadImage(
      file, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, image);
}

// The texture multiplies the lit colours, which are at most white, in a second pass. In a single
// pass, Gazebo's shaders would wash out bright surfaces.
Ogre::Pass* opaque_texture_pass(Ogre::Pass& lit) {
  Ogre::Pass* textured = lit.getParent()->createPass();
  textured->setLightingEnabled(false);
  textured->setSceneBlending(Ogre::SBT_MODULATE);
  textured->setDepthWriteEnabled(false);
  textured->setDepthBias(1.0F);
  return textured;
}

// A second pass would multiply the background as well. As in the embedded simulator, both sides of
// transparent surfaces are blended.
Ogre::Pass* blended_texture_pass(Ogre::Pass& lit) {
  lit.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  lit.setDepthWriteEnabled(false);
  lit.setCullingMode(Ogre::CULL_NONE);
  return &lit;
}

std::string make_material(const VisualMaterial& wanted, const TextureRepeat& repeat) {
  const std::string name = "tether/" + name_of(wanted);
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(
      name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  Ogre::Pass* lit = material->getTechnique(0)->getPass(0);
  Ogre::ColourValue diffuse = colour(wanted.diffuse_rgb);
  diffuse.a = static_cast<float>(wanted.alpha);
  lit->setAmbient(colour(wanted.ambient_rgb));
  lit->setDiffuse(diffuse);
  lit->setSpecular(colour(wanted.specular_rgb));
  lit->setSelfIllumination(colour(wanted.emissive_rgb));
  lit->setShininess(kShininess);
  load_texture(wanted.texture);
  Ogre::Pass* textured =
      wanted.alpha < 1.0 ? blended_texture_pass(*lit) : opaque_texture_pass(*lit);
  Ogre::TextureUnitState* unit = textured->createTextureUnitState(wanted.texture);
  unit->setTextureFiltering(Ogre::TFO_TRILINEAR);
  unit->setTextureScale(static_cast<float>(1.0 / repeat.x), static_cast<float>(1.0 / repeat.y));
  return name;
}

void make_mesh(const std::string& name, const BoxMesh& box) {
  Ogre::ManualObject object(name);
  object.begin("", Ogre::RenderOperation::OT_TRIANGLE_LIST);
  const auto f = [](double x) { return static_cast<float>(x); };
  for (const BoxVertex& vertex : box.vertices) {
    object.position(f(vertex.position.x), f(vertex.position.y), f(vertex.position.z));
    object.normal(f(vertex.normal.x), f(vertex.normal.y), f(vertex.normal.z));
    object.textureCoord(f(vertex.u), f(vertex.v));
  }
  for (const auto& t : box.triangles) object.triangle(t[0], t[1], t[2]);
  object.end();
  object.convertToMesh(name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
}

Ogre::Entity* entity_of(Ogre::SceneNode& node) {
  for (unsigned short i = 0; i < node.numAttachedObjects(); ++i) {
    if (auto* entity = dynamic_cast<Ogre::Entity*>(node.getAttachedObject(i))) return entity;
  }
  return nullptr;
}

// Gazebo's own box has the texture once on each face. The node keeps scaling it.
Ogre::Entity* replace_box(Ogre::SceneNode& node, Ogre::Entity& old, const VisualMaterial& wanted,
                          const uav::Vec3& size_m) {
  const std::string name = "tether/" + name_of(wanted);
  Ogre::SceneManager& manager = *node.getCreator();
  make_mesh(name, textured_box(size_m, wanted.texture_repeat_x, wanted.texture_repeat_y));
  Ogre::Entity* entity = manager.createEntity(name, name);
  entity->setVisibilityFlags(old.getVisibilityFlags());
  entity->setCastShadows(old.getCastShadows());
  entity->getUserObjectBindings().setUserAny(old.getUserObjectBindings().getUserAny());
  node.detachObject(&old);
  manager.destroyEntity(&old);
  node.attachObject(entity);
  return entity;
}

void apply(const ::gazebo::rendering::VisualPtr& visual, const VisualMaterial& wanted) {
  Ogre::SceneNode& node = *visual->GetSceneNode();
  Ogre::Entity* entity = entity_of(node);
  if (!entity) return;
  const Ogre::Vector3& scale = node.getScale();
  const uav::Vec3 size_m{scale.x, scale.y, scale.z};
  const std::string mesh = visual->GetMeshName();
  if (mesh == "unit_box") entity = replace_box(node, *entity, wanted, size_m);
  entity->setMaterialName(make_material(
      wanted, texture_repeat(mesh, size_m, wanted.texture_repeat_x, wanted.texture_repeat_y)));
}

}  // namespace

void apply_materials(const ::gazebo::rendering::ScenePtr& scene,
                     const std::vector<VisualMaterial>& materials) {
  for (const VisualMaterial& wanted : materials) {
    const ::gazebo::rendering::VisualPtr visual = scene->GetVisual(name_of(wanted));
    if (!visual) {
      throw Error(ErrorCode::kSetup, "Gazebo's world has no visual '" + name_of(wanted) +
                                         "'; load the world file of the scenario in gzserver");
    }
    apply(visual, wanted);
  }
  ::gazebo::rendering::RTShaderSystem::Instance()->UpdateShaders();
}

}  // namespace tether::gazebo_plugin
