#include "mapping/grazing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "mapping/cell_key.hpp"
#include "mapping/local_plane.hpp"
#include "projection/grazing_emissivity.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFewest = 8;    // points that make a plane
constexpr double kLeastWidth = 3.0;   // of a plane, in sigmas of the range
constexpr float kLeastCosine = 0.2F;  // of the angle at which a laser still sees a surface
constexpr double kFarthest = 1e9;     // cubes from the origin that keys tell apart
constexpr std::uint32_t kNone = UINT32_MAX;

/// The points of a cube, seen from the first of them.
struct Cube {
  Eigen::Vector3d origin;
  PointSums sums;
};

/// Cubes of space, made as points come.
class Cubes {
 public:
  Cubes(double edge, std::size_t points) : inverse_edge_(1.0 / edge) { places_.reserve(points / kFewest); }

  /// Number of the cube that holds the point.
  std::uint32_t add(const Eigen::Vector3d& p) {
    const Eigen::Vector3d cell = (p * inverse_edge_).array().floor().cwiseMax(-kFarthest).cwiseMin(kFarthest);
    const BlockKey key{static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
                       static_cast<std::int32_t>(cell.z())};
    if (last_ == kNone || key != last_key_) {
      const auto [place, is_new] = places_.try_emplace(key, static_cast<std::uint32_t>(cubes_.size()));
      if (is_new) cubes_.push_back({p, {}});
      last_ = place->second;
      last_key_ = key;
    }
    cubes_[last_].sums.add(p - cubes_[last_].origin);
    return last_;
  }

  [[nodiscard]] std::vector<Eigen::Vector3f> normals(double least_width) const {
    std::vector<Eigen::Vector3f> normals(cubes_.size(), Eigen::Vector3f::Zero());
    for (std::size_t i = 0; i < cubes_.size(); ++i) {
      if (cubes_[i].sums.count < kFewest) continue;
      const LocalPlane plane = localPlane(cubes_[i].sums);
      if (plane.width2 > least_width * least_width) normals[i] = plane.normal;
    }
    return normals;
  }

 private:
  double inverse_edge_;
  std::unordered_map<BlockKey, std::uint32_t, BlockKeyHash> places_;
  std::vector<Cube> cubes_;
  BlockKey last_key_;
  std::uint32_t last_ = kNone;
};

}  // namespace

GrazingView grazingView(const Eigen::Vector3f& normal, const SeenSurface& seen, const ThermalView& view,
                        double reflected) {
  if (normal.isZero()) return {};
  const Eigen::Vector3f to_camera =
      (view.T_world_camera.translation - seen.p_world).cast<float>().normalized();
  const float cosine = std::min(std::abs(normal.dot(to_camera)), 1.0F);
  const float difference = std::abs(seen.celsius - static_cast<float>(reflected));
  return {std::acos(cosine), emissivityLoss(cosine) * difference};
}

Colour distrusted(Colour colour, const GrazingView& grazing) {
  colour.sigma = std::hypot(colour.sigma, grazing.sigma);
  return colour;
}

double reflectedTemperature(const ThermalImage& image, const std::optional<double>& ambient) {
  if (image.air) return image.air->parameters().reflected;
  return ambient.value_or(RadiometricParameters{}.reflected);
}

std::vector<Eigen::Vector3f> readingNormals(std::span<const PlacedReturn> returns,
                                            std::span<const std::optional<FrameColour>> found, double edge,
                                            double range_sigma) {
  std::vector<Eigen::Vector3f> normals(returns.size(), Eigen::Vector3f::Zero());
  const auto coloured = static_cast<std::size_t>(
      std::count_if(found.begin(), found.end(), [](const auto& colour) { return colour.has_value(); }));
  if (coloured < kFewest) return normals;
  Cubes cubes(edge, coloured);
  std::vector<std::uint32_t> cube_of(returns.size(), kNone);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (found[i]) cube_of[i] = cubes.add(returns[i].p_world);
  }
  const std::vector<Eigen::Vector3f> of_cubes = cubes.normals(kLeastWidth * range_sigma);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (cube_of[i] == kNone) continue;
    const Eigen::Vector3f& normal = of_cubes[cube_of[i]];
    const Eigen::Vector3f to_laser =
        (returns[i].origin_world - returns[i].p_world).cast<float>().normalized();
    if (std::abs(normal.dot(to_laser)) > kLeastCosine) normals[i] = normal;
  }
  return normals;
}

Eigen::Vector3f trustedNormal(const SceneSurface& surface, double range_sigma) {
  return surface.width > kLeastWidth * range_sigma ? surface.normal : Eigen::Vector3f::Zero();
}

std::vector<Eigen::Vector3f> sceneNormals(std::span<const PlacedReturn> returns,
                                          std::span<const std::optional<FrameColour>> found,
                                          SceneSurfaces& scene, double range_sigma) {
  std::vector<Eigen::Vector3f> normals(returns.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (!found[i]) continue;
    if (const SceneSurface* surface = scene.surfaceAt(returns[i].p_world))
      normals[i] = trustedNormal(*surface, range_sigma);
  }
  return normals;
}

std::vector<GrazingView> grazingViews(std::span<const PlacedReturn> returns,
                                      std::span<const std::optional<FrameColour>> found,
                                      std::span<const Eigen::Vector3f> normals,
                                      const std::optional<double>& ambient) {
  std::vector<GrazingView> views(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (!found[i]) continue;
    const ThermalView& view = *found[i]->view;
    views[i] = grazingView(normals[i], {returns[i].p_world, found[i]->colour.celsius}, view,
                           reflectedTemperature(*view.frame.image, ambient));
  }
  return views;
}

}  // namespace thermovox
