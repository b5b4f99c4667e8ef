#include "mapping/hot_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapping/percentile.hpp"
#include "mapping/surface_height.hpp"

namespace thermovox {
namespace {

constexpr double kBand = 2.0;              // cells off its plane that a peak is fitted to
constexpr std::size_t kEnough = 12;        // samples seen from the front, to leave out the others
constexpr double kLeastModelError = 0.01;  // of a peak's rise, by which each sample may differ from the model
constexpr double kSurfaceError = 0.6e-3;   // metres: what a surface differs from a quadric by
constexpr double kPlaceError = 0.6e-3;     // metres: of temperatures in their cells, that all share
constexpr double kWarm = 0.2;              // of a peak's rise
constexpr double kDoubtful = 2.0;          // times the sigma of most
constexpr double kBulgeError = 0.15;       // of a width: what a peak on a pipe of this radius is off along it
constexpr int kRounds = 8;

class CandidateFit {
 public:
  CandidateFit(const SurfaceLayer& layer, const CameraSight& camera, const std::vector<bool>& hot)
      : layer_(layer), camera_(camera), hot_(hot) {}

  [[nodiscard]] std::optional<PeakFit> of(const HotCandidate& candidate) const {
    const double rise = candidate.hottest - candidate.reference.celsius;
    const double width = std::clamp(std::sqrt(candidate.spread2 / 2.0) * 1.2, 0.6 * layer_.resolution(), 1.0);
    const std::vector<PeakSample> samples = samplesAround(candidate, std::clamp(4.0 * width, 0.25, 1.5));
    if (samples.size() < 6 || !(rise > 0.0)) return std::nullopt;
    PeakPrior prior{.guess = {candidate.centroid, rise, width, candidate.reference.celsius},
                    .normal = candidate.normal};
    prior.blur_sigma = camera_.blur_sigma;
    prior.reference_sigma = std::max(candidate.reference.sigma, 0.5);
    std::optional<PeakFit> fit = fitPeak(samples, prior);
    if (!fit) return fit;
    // Where the samples follow the model more closely than was feared, what they differ by is its error.
    prior.model_error = std::max(prior.model_error * std::min(fit->misfit, 1.0), kLeastModelError);
    double curvature = 0.0;
    for (int round = 0; round < kRounds; ++round) {  // the centre moves, and with it the curved surface
      curvature = putOnSurface(samples, fit->model, prior);
      const std::optional<PeakFit> closer = fitPeak(samples, prior);
      if (!closer) break;
      const double moved = (closer->model.centre - fit->model.centre).norm();
      fit = closer;
      if (moved < kSurfaceError) break;
    }
    const double along = kBulgeError * std::min(curvature * fit->model.width, 1.0) * fit->model.width;
    fit->covariance.topLeftCorner<3, 3>() +=
        (along * along + kPlaceError * kPlaceError) *
        (Eigen::Matrix3d::Identity() - prior.normal * prior.normal.transpose());
    return fit;
  }

 private:
  [[nodiscard]] std::vector<PeakSample> samplesAround(const HotCandidate& candidate, double radius) const {
    std::vector<PeakSample> facing, all;
    for (const std::uint32_t i : layer_.within(candidate.centroid, radius)) {
      const SurfaceSample& sample = layer_[i];
      const double off = candidate.normal.dot(sample.p_world - candidate.centroid);
      const bool own = std::binary_search(candidate.cells.begin(), candidate.cells.end(), i);
      if (!own && (hot_[i] || std::abs(off) > kBand * layer_.resolution())) continue;
      all.push_back({sample.p_world, sample.celsius, sample.sigma, sample.returns,
                     blurOfCell(i, candidate, layer_, camera_)});
      if (all.back().blur.fromTheFront()) facing.push_back(all.back());
    }
    return withoutDoubtful(facing.size() >= kEnough ? std::move(facing) : std::move(all), candidate);
  }

  /// Beside the edge of something nearer a temperature is off to one side, and its sigma says so: such
  /// samples would pull a peak, however little they weigh. Those that are much less sure than most of the
  /// warm ones are left out, where enough others are there.
  [[nodiscard]] static std::vector<PeakSample> withoutDoubtful(std::vector<PeakSample> samples,
                                                               const HotCandidate& candidate) {
    const double warm =
        candidate.reference.celsius + kWarm * (candidate.hottest - candidate.reference.celsius);
    std::vector<double> sigmas;
    for (const PeakSample& sample : samples) {
      if (sample.celsius > warm) sigmas.push_back(sample.sigma);
    }
    if (sigmas.empty()) return samples;
    std::sort(sigmas.begin(), sigmas.end());
    const double most = kDoubtful * percentile(sigmas, 0.5);
    std::vector<PeakSample> sure;
    std::copy_if(samples.begin(), samples.end(), std::back_inserter(sure),
                 [most](const PeakSample& sample) { return sample.sigma <= most; });
    return sure.size() >= kEnough ? sure : samples;
  }

  /// The peak lies on the surface, which the samples know better than their temperatures do. The surface's
  /// curvature, 1/m; 0 where it is not known.
  double putOnSurface(const std::vector<PeakSample>& samples, const PeakModel& model,
                      PeakPrior& prior) const {
    prior.guess.centre = model.centre;
    if (prior.normal.isZero()) return 0.0;
    std::vector<HeightPoint> near;
    const double radius = std::max(2.0 * model.width, 3.0 * layer_.resolution());
    for (const PeakSample& sample : samples) {
      if (sample.returns > 0 && (sample.p_world - model.centre).norm() < radius) {
        near.push_back({sample.p_world, static_cast<double>(sample.returns)});
      }
    }
    const auto height = surfaceHeight(near, model.centre, prior.normal, layer_.resolution());
    if (!height) return 0.0;
    prior.guess.centre += height->height * prior.normal;
    prior.normal = height->normal;
    prior.surface_sigma = std::hypot(height->sigma, kSurfaceError);
    return height->curvature;
  }

  const SurfaceLayer& layer_;
  const CameraSight& camera_;
  const std::vector<bool>& hot_;
};

}  // namespace

std::optional<PeakFit> fitCandidate(const HotCandidate& candidate, const SurfaceLayer& layer,
                                    const CameraSight& camera, const std::vector<bool>& hot) {
  return CandidateFit(layer, camera, hot).of(candidate);
}

bool peakIsWithin(const HotCandidate& candidate, const SurfaceLayer& layer) {
  const PeakModel& model = candidate.fit->model;
  const double most = std::max(model.width, 2.0 * layer.resolution());
  return std::any_of(candidate.cells.begin(), candidate.cells.end(), [&](std::uint32_t i) {
    return layer[i].celsius >= candidate.hottest && (layer[i].p_world - model.centre).norm() <= most;
  });
}

SurfaceBlur blurOfCell(std::uint32_t sample, const HotCandidate& candidate, const SurfaceLayer& layer,
                       const CameraSight& camera) {
  const Eigen::Vector3f& own = layer.normal(sample);
  const Eigen::Vector3d normal = own.isZero() ? candidate.normal : own.cast<double>();
  return blurOf(layer[sample], normal, camera);
}

}  // namespace thermovox
