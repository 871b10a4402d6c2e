#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/energy/meter.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/path.h>
#include <tether/uav/sensor_timing.h>
#include <tether/uav/setpoint.h>
#include <tether/uav/wind.h>

/// The scene for every back end: the content of the SDF files with everything resolved (poses in W,
/// files found, units SI).
namespace tether::sim {

struct BoxGeometry {
  uav::Vec3 size_m;  ///< edge lengths
};
struct CylinderGeometry {
  double radius_m = 0.0;
  double length_m = 0.0;  ///< along z
};
struct SphereGeometry {
  double radius_m = 0.0;
};
struct CapsuleGeometry {
  double radius_m = 0.0;
  double length_m = 0.0;  ///< of the cylindrical part, along z
};
struct EllipsoidGeometry {
  uav::Vec3 radii_m;
};
struct PlaneGeometry {
  uav::Vec3 normal;
  double size_x_m = 0.0;
  double size_y_m = 0.0;
};
struct MeshGeometry {
  /// Absolute, exists: .obj, .stl, .dae, .glb or .gltf; or a picture whose brightness is a height,
  /// 1 × 1 × 1 m before it is scaled.
  std::filesystem::path file;
  std::string submesh;  ///< empty: all
  uav::Vec3 scale{1.0, 1.0, 1.0};
  bool is_centered = false;  ///< moved so that the middle of its extent is the origin
  FileLocation named_at{};   ///< where the world names the file; empty: in no file
  /// What else it is made of: libraries of materials, pictures and buffers that it names. Absolute.
  std::vector<std::filesystem::path> companions{};
  std::optional<std::size_t> piece{};  ///< only this one of its connected pieces; none: all
  /// Text of an OBJ file that does not exist: `file` is a name that tells it from others.
  std::shared_ptr<const std::string> made{};
};
using Geometry = std::variant<BoxGeometry, CylinderGeometry, SphereGeometry, CapsuleGeometry,
                              EllipsoidGeometry, PlaneGeometry, MeshGeometry>;

/// A visitor of a Geometry, or of a sensor's model, that is made of one lambda for each type.
template <class... Lambdas>
struct Visitor : Lambdas... {
  using Lambdas::operator()...;
};
template <class... Lambdas>
Visitor(Lambdas...) -> Visitor<Lambdas...>;

/// What the repetitions of a texture are counted over.
enum class TextureRepeat {
  kPerMetre,  ///< a metre of surface; the texture coordinates of a mesh are kept
  kPerFace,   ///< each face of a box or a plane, each other surface, and the coordinates of a mesh
};

/// The material of a surface. A texture is multiplied by the colours. On a flat face it begins in
/// the upper left corner, seen from outside.
struct Material {
  uav::Vec3 diffuse_rgb{0.7, 0.7, 0.7};  ///< each 0..1
  uav::Vec3 ambient_rgb{0.7, 0.7, 0.7};
  uav::Vec3 specular_rgb;
  uav::Vec3 emissive_rgb;
  double alpha = 1.0;
  std::filesystem::path albedo_map;  ///< PNG or JPEG; empty: none
  double texture_repeat_x = 1.0;
  double texture_repeat_y = 1.0;
  FileLocation albedo_map_at{};  ///< where the world names the texture; empty: in no file
  TextureRepeat texture_repeat = TextureRepeat::kPerMetre;  ///< SDF's default: kPerFace
  bool is_double_sided = false;                             ///< also seen from inside
  bool is_of_script = false;  ///< of a <script>, which Gazebo 11 reads itself
};

struct Visual {
  std::string name;
  uav::Pose X_LV;  ///< in its link
  Geometry geometry;
  Material material;
  bool cast_shadows = true;
  /// Looks as the file of its mesh says, times the `alpha`, `diffuse_rgb` and `ambient_rgb` of
  /// `material`.
  bool has_look_of_mesh = false;
  /// Of a UAV: it is behind so many of its joints, and `X_LV` is its pose while they are at 0.
  std::size_t joints = 0;
};

struct Collision {
  std::string name;
  uav::Pose X_LC;
  Geometry geometry;
  double friction = 1.0;
  double intensity = 0.0;  ///< of the light of a lidar that comes back; not negative
  /// Shapes that have none in common do not touch; of 31.
  std::uint32_t bits = 0xffff;
};

struct Link {
  std::string name;
  uav::Pose X_ML;  ///< in its model
  double mass_kg = 1.0;
  uav::Pose X_LI;  ///< centre of mass and principal axes
  uav::Vec3 inertia_kg_m2{1.0, 1.0, 1.0};
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
};

/// How a model is driven.
struct DrivenPath : uav::Path {
  uav::Vec3 p_WO{};  ///< about which it turns: the origin of the outermost model that is driven
};

struct Model {
  std::string name;
  uav::Pose X_WM;
  bool is_static = false;  ///< a dynamic model's links are free bodies; joints are warned about
  std::vector<Link> links;
  /// Of a driven model, which is dynamic: it moves so from `X_WM` on, whatever it meets.
  std::optional<DrivenPath> path{};
};

enum class LightKind { kPoint, kDirectional, kSpot };
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  uav::Pose X_WL;
  uav::Vec3 direction{0.0, 0.0, -1.0};  ///< in its own frame
  uav::Vec3 diffuse_rgb{1.0, 1.0, 1.0};
  uav::Vec3 specular_rgb;
  double attenuation_constant = 1.0, attenuation_linear = 0.0, attenuation_quadratic = 0.0;
  double spot_outer_angle_rad = 0.8;
  double spot_falloff = 0.0;
  bool cast_shadows = false;
};

/// Gaussian noise of one sensor channel, as SDF's <noise>. The bias of a run is drawn once from
/// (bias_mean, bias_stddev); dynamic bias is a first-order Gauss-Markov walk.
struct Noise {
  double mean = 0.0;
  double stddev = 0.0;
  double bias_mean = 0.0;
  double bias_stddev = 0.0;
  double dynamic_bias_stddev = 0.0;
  double dynamic_bias_correlation_time_s = 0.0;
  friend bool operator==(const Noise&, const Noise&) = default;
};

struct CameraModel {
  uav::CameraModel intrinsics;
  double near_m = 0.05;
  double far_m = 100.0;
  Noise pixel_noise;  ///< of intensities 0..1; of a depth camera, of depths [m]
  /// How long each row gathers light [s]; 0: an instant. What moves meanwhile is blurred, by the
  /// mean of the light (not of the sRGB bytes).
  double exposure_s = 0.0;
  /// Rolling shutter: from the end of the first row's exposure to the end of the last row's [s];
  /// 0: all rows at once. A sample's `sampled_at` is the end of the LAST row's exposure, so that
  /// nothing in an image is from its future: of H rows, row r gathers light during
  /// [e − exposure_s, e] with e = sampled_at − readout_s·(H−1−r)/(H−1). Neither is negative, and
  /// both together are at most 1 s.
  double readout_s = 0.0;
  /// The colour of a pixel at an edge is a mixture by the share of the pixel that each surface
  /// covers. Otherwise, and always for depths, labels and the visible pixels of anchors, the
  /// surface in the pixel's centre counts. Only for cameras with colours.
  bool antialias = false;
  FileLocation antialias_at{};  ///< where `antialias` was set; empty: in no file
  uav::CameraKind kind = uav::CameraKind::kColor;
  /// Of depths: what is nearer reads −inf, what is farther (or nothing) +inf (REP-117) [m].
  double depth_min_m = 0.0;
  double depth_max_m = 0.0;
};
struct ImuModel {
  std::array<Noise, 3> angular_velocity;     ///< x, y, z [rad/s]
  std::array<Noise, 3> linear_acceleration;  ///< x, y, z [m/s²]
};
/// A rangefinder reads the distance of the nearest thing on any of its rays. Farther than `max_m`,
/// or nothing at all, reads +inf; closer than `min_m` reads −inf (REP-117); never NaN.
struct RangeModel {
  double min_m = 0.02;
  double max_m = 10.0;
  double resolution_m = 0.0;  ///< 0: continuous
  Noise noise;                ///< of the nearest distance [m]
  std::vector<uav::Vec3> rays_S{
      {1.0, 0.0, 0.0}};              ///< unit vectors in the sensor's frame, not empty
  double dropout_probability = 0.0;  ///< 0..1, of a measurement that reads +inf whatever is there
};

struct NavSatModel {
  Noise horizontal_m;  ///< along east and along north
  Noise vertical_m;
  Noise horizontal_velocity_m_s;
  Noise vertical_velocity_m_s;
  /// Without a fix: one outage begins in each `outage_every_s`, at a random instant, and lasts
  /// `outage_lasts_s`, which is at most as long. 0: none.
  double outage_every_s = 0.0;
  double outage_lasts_s = 0.0;
};
struct MagnetometerModel {
  std::array<Noise, 3> field_T;  ///< x, y, z
  uav::Vec3 hard_iron_T;         ///< in S: of the UAV itself
};
struct BarometerModel {
  Noise pressure_Pa;
  std::optional<double> reference_altitude_m{};  ///< of W's origin; none: that of the place
};
struct OdometryModel {
  Noise position_m;  ///< along each of W's axes
  Noise velocity_m_s;
  Noise tilt_rad;  ///< about W's x and y
  Noise yaw_rad;   ///< about W's z
  Noise angular_velocity_rad_s;
};

/// A lidar: rays as in uav::ScanProperties.
struct ScanModel {
  uav::ScanProperties rays;
  double resolution_m = 0.0;         ///< 0: continuous
  Noise noise;                       ///< of distances [m]
  double dropout_probability = 0.0;  ///< of a ray, which then reads +inf
};

/// The angles of all joints of a UAV.
struct JointStateModel {
  Noise angle_rad;  ///< of each joint
};

struct Sensor {
  std::string name;
  uav::Pose X_BS;               ///< in the UAV's body frame, while its joints are at 0
  double update_rate_hz = 0.0;  ///< SDF's <update_rate>; 0: none given
  /// In the order of uav::SensorKind.
  std::variant<CameraModel, ImuModel, RangeModel, NavSatModel, MagnetometerModel, BarometerModel,
               OdometryModel, ScanModel, JointStateModel>
      model;
  FileLocation declared_at{};  ///< in its SDF file; empty: in none
  uav::DriverModel driver{};   ///< how its samples are stamped and delivered
  /// It is behind so many joints of its UAV. Only cameras, rangefinders and lidars are.
  std::size_t joints = 0;
  uav::SensorKind kind() const { return static_cast<uav::SensorKind>(model.index()); }
};

/// What a UAV carries for a time: a point at its centre of mass. Its controller does not know it.
struct Payload {
  double mass_kg = 0.0;            ///< ≥ 0
  SimTime from{};                  ///< the first step with it begins here or later
  SimTime until = SimTime::max();  ///< the first step without it begins here or later
};

/// A UAV of the scene: its model (visuals and collisions of its body link), its airframe and its
/// sensors.
struct Uav {
  std::string name;
  uav::Pose X_WB;  ///< at ST 0
  Link body;
  uav::MultirotorParameters airframe;
  std::vector<Sensor> sensors;
  /// That of its SDF file; none: it has none. Used only if `energy` is made from it.
  std::optional<energy::Battery> battery{};
  std::optional<energy::Model> energy{};  ///< none: energy is not simulated
  std::vector<Payload> payloads{};
  std::vector<uav::Joint> joints{};  ///< at most uav::kMaxJoints
  /// What its file has of `airframe`: "<tether:multirotor>", or plugins of its motors.
  std::string airframe_from{};
  /// What of <tether:multirotor> it lacks, which has the values of the Hummingbird.
  std::vector<std::string> by_default{};
};

/// An anchor: a model of the world, or a UAV, that SUTs receive in their catalogue.
struct PlacedAnchor {
  uav::Anchor anchor;
  uav::Pose X_WA;  ///< its centre, at ST 0
};

/// Where W's origin is on Earth.
struct Place {
  double latitude_deg = 47.397971;  ///< WGS 84; that of PX4's worlds
  double longitude_deg = 8.546164;
  double elevation_m = 488.0;  ///< above the ellipsoid
  double heading_rad = 0.0;    ///< from W's y to north, counter-clockwise seen from above
};

struct World {
  std::string name;
  std::filesystem::path file;                         ///< its own SDF file, absolute; empty: none
  double gravity_m_s2 = 9.81;                         ///< along −z of W; not negative
  double gravity_x_m_s2 = 0.0, gravity_y_m_s2 = 0.0;  ///< of a tilted one, along x and y
  Duration step = std::chrono::milliseconds(1);
  std::string step_from = "default";  ///< who sets the step: "default", "world" or "scenario"
  FileLocation step_at{};             ///< where; empty: nobody does
  std::optional<Place> place{};       ///< none: the world does not say; Place's own values are used
  uav::Vec3 magnetic_field_T{6e-6, 2.3e-5, -4.2e-5};  ///< in W; SDF's
  uav::Wind wind;                                     ///< acts on UAVs
  uav::Vec3 ambient_rgb{0.4, 0.4, 0.4};
  uav::Vec3 background_rgb{0.7, 0.7, 0.7};
  std::vector<Model> models;
  std::vector<Light> lights;
  std::vector<Uav> uavs;
  std::vector<PlacedAnchor> anchors;
  std::set<std::filesystem::path>
      files;  ///< all files that it was read from: SDF, meshes, textures; absolute
  /// Of these, `file` and the SDF files that it includes: not those of the UAVs.
  std::set<std::filesystem::path> sdf_files;
  bool is_strict = false;  ///< as WorldOptions: of meshes and textures that cannot be read
};

/// What a body at rest measures [m/s²], in W: gravity, pointing the other way.
inline uav::Vec3 felt_at_rest(const World& world) {
  return {-world.gravity_x_m_s2, -world.gravity_y_m_s2, world.gravity_m_s2};
}

/// A UAV and its start pose.
struct UavPlacement {
  std::string name;
  std::filesystem::path model;  ///< SDF file with one <model>
  uav::Vec3 p_WB;
  double yaw_rad = 0.0;
};

/// How strictly files are read, and where models are searched for besides the usual places.
struct WorldOptions {
  std::vector<std::filesystem::path> model_folders{};  ///< for model://, after the environment's
  /// What of a world cannot be used is an error; otherwise it is left out or mended, with a warning
  /// each: models, meshes and textures that are not found, what is too far away or too large,
  /// shapes with bad values, names that occur twice, impossible inertias, gravity that points up.
  bool is_strict = false;
  /// The same for UAVs: whether what cannot be used is left out or mended.
  bool is_tolerant = false;

  friend bool operator==(const WorldOptions&, const WorldOptions&) = default;
};

struct WorldRequest {
  std::filesystem::path world;  ///< SDF file with one <world>
  std::vector<UavPlacement> uavs;
  std::vector<std::string> anchors;  ///< names of models of the world, or of UAVs
  FileLocation anchors_at{};         ///< where they are requested; empty: in no file
  WorldOptions options{};
};

using tether::WarningSink;

/// Maximum number of links of dynamic models in a world. The engine's memory grows with the square
/// of their number.
inline constexpr std::size_t kMaxMovingLinks = 200;

/// " (set at FILE:LINE)" of the world's step; empty if nobody sets it.
std::string set_at(const World& world);

/// Limits of the step of a simulation.
inline constexpr Duration kLeastStep = std::chrono::microseconds(10);
inline constexpr Duration kMostStep = std::chrono::milliseconds(100);

/// The name of the model with the number that a view has for each of its pixels: the models of the
/// world from 1, then the UAVs (0: none of them). @throws std::out_of_range for another number.
const std::string& model_name(const World& world, std::size_t number);
/// The names from number 1 on.
std::vector<std::string> model_names(const World& world);

/// The catalogue that the SUT of `uav` receives.
uav::Catalogue make_catalogue(const World& world, const Uav& uav);

/// What distinguishes two uses of meshes: file, submesh, scale, whether it is centered, and piece.
using MeshKey = std::tuple<std::filesystem::path, std::string, double, double, double, bool,
                           std::optional<std::size_t>>;

inline MeshKey key_of(const MeshGeometry& mesh) {
  return {mesh.file,    mesh.submesh,     mesh.scale.x, mesh.scale.y,
          mesh.scale.z, mesh.is_centered, mesh.piece};
}

}  // namespace tether::sim
