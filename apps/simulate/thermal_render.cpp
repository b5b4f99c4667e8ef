#include "apps/simulate/thermal_render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/simulate/random.hpp"
#include "apps/simulate/simulated_rig.hpp"

namespace thermovox::simulate {
namespace {

constexpr int kMargin = 3;  // pixels sampled around the image, so that the blur has something to mix

/// The part of the blur that averaging the samples of a pixel does not make already, as a Gaussian over
/// samples. The samples of a pixel have the variance (1 - 1 / n^2) / 12 px^2.
std::vector<double> opticsKernel(double blur_px, int samples) {
  const double n = samples;
  const double variance_px = blur_px * blur_px - (1.0 - 1.0 / (n * n)) / 12.0;
  if (variance_px <= 0.0) return {1.0};
  const double sigma = n * std::sqrt(variance_px);
  const int reach = std::clamp(static_cast<int>(std::ceil(4.0 * sigma)), 1, kMargin * samples);
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// What is seen of a surface through `distance` metres of air, as decoded with distance 0.
double throughAir(double celsius, double distance, const RadiometricParameters& without_air) {
  RadiometricParameters with_air = without_air;
  with_air.distance = distance;
  return celsiusOfCounts(countsOfCelsius(celsius, with_air), without_air);
}

}  // namespace

ThermalRenderer::ThermalRenderer(const Simulation& simulation)
    : simulation_(simulation), samples_(simulation.options().supersampling) {
  if (simulation.options().frames == FrameFormat::rjpeg) {
    radiometry_ = makeRadiometry(simulation.options());
    radiometry_->distance = 0.0;
  }
  const ThermalCamera& thermal = *simulation.rig().thermal_camera;
  columns_ = (thermal.camera.width() + 2 * kMargin) * samples_;
  rows_ = (thermal.camera.height() + 2 * kMargin) * samples_;
  kernel_ = opticsKernel(thermal.blur_px, samples_);
  rays_camera_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  const auto pixelOf = [this](int sample) { return (sample + 0.5) / samples_ - 0.5 - kMargin; };
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto ray = thermal.camera.rayFromPixel({pixelOf(column), pixelOf(row)});
      rays_camera_.push_back(ray ? Eigen::Vector3f(ray->normalized().cast<float>())
                                 : Eigen::Vector3f::Zero());
    }
  }
}

std::vector<float> ThermalRenderer::sampleRays(const Pose& T_world_body) const {
  const Pose T_world_camera = T_world_body * simulation_.rig().thermal_camera->T_body_camera;
  const Eigen::Matrix3d R_world_camera = T_world_camera.matrix();
  std::vector<float> celsius(rays_camera_.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < rays_camera_.size(); ++i) {
    if (rays_camera_[i].isZero(0.0F)) continue;
    const Eigen::Vector3d d_world = R_world_camera * rays_camera_[i].cast<double>();
    const auto hit = simulation_.hall().castRay(T_world_camera.translation, d_world);
    if (!hit) continue;
    celsius[i] = static_cast<float>(radiometry_ ? throughAir(hit->temperature, hit->range, *radiometry_)
                                                : hit->temperature);
  }
  return celsius;
}

/// Convolves along one axis (stride 1: columns, stride columns_: rows); the weights of known samples count.
std::vector<float> ThermalRenderer::blurAlong(const std::vector<float>& samples, std::size_t stride) const {
  std::vector<float> blurred(samples.size());
  const auto line = static_cast<std::size_t>(stride == 1 ? columns_ : rows_);
  const std::size_t reach = kernel_.size() / 2;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t place = i / stride % line;
    const std::size_t first = place - std::min(place, reach);
    const std::size_t last = std::min(place + reach, line - 1);
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t j = first; j <= last; ++j) {
      const float value = samples[i + j * stride - place * stride];
      if (std::isnan(value)) continue;
      const double weight = kernel_[j + reach - place];
      sum += weight * value;
      weights += weight;
    }
    blurred[i] = weights > 0.0 ? static_cast<float>(sum / weights) : std::numeric_limits<float>::quiet_NaN();
  }
  return blurred;
}

std::vector<float> ThermalRenderer::render(const Pose& T_world_body) const {
  const std::vector<float> rows_blurred = blurAlong(sampleRays(T_world_body), 1);
  const std::vector<float> blurred = blurAlong(rows_blurred, static_cast<std::size_t>(columns_));
  const Camera& camera = simulation_.rig().thermal_camera->camera;
  std::vector<float> image;
  image.reserve(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()));
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      double sum = 0.0;
      for (int row = (v + kMargin) * samples_; row < (v + kMargin + 1) * samples_; ++row) {
        const auto start = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
        const auto first = start + static_cast<std::size_t>((u + kMargin) * samples_);
        for (std::size_t i = first; i < first + static_cast<std::size_t>(samples_); ++i) sum += blurred[i];
      }
      image.push_back(static_cast<float>(sum / (samples_ * samples_)));
    }
  }
  return image;
}

double ThermalRenderer::countOf(double celsius) const {
  if (radiometry_) return countsOfCelsius(celsius, *radiometry_);
  const TLinear& t_linear = *simulation_.rig().thermal_camera->t_linear;
  return (celsius - t_linear.celsius_offset) / t_linear.celsius_per_count;
}

std::vector<std::uint16_t> ThermalRenderer::counts(std::size_t frame) const {
  const std::vector<float> celsius = render(simulation_.truePose(simulation_.frameStamp(frame)));
  const SimulationOptions& options = simulation_.options();
  Random noise(options.seed, RandomStream::thermal_noise, frame);
  const double offset = simulation_.drawnErrors().camera_bias;
  std::vector<std::uint16_t> counts;
  counts.reserve(celsius.size());
  for (const float surface : celsius) {
    const double shown = surface + offset + options.netd * noise.normal();
    const double count = std::round(countOf(shown));
    counts.push_back(std::isnan(count) ? 0 : static_cast<std::uint16_t>(std::clamp(count, 1.0, 65535.0)));
  }
  return counts;
}

}  // namespace thermovox::simulate
