#include "projection/colouring_batch.hpp"

#include <algorithm>
#include <cmath>

#include "projection/colouring_block.hpp"

namespace thermovox {
namespace {

/// Into the image, in one go for each level.
template <LensModel kModel>
THERMOVOX_INLINE_LOOP void lookLoop(ColouringBlock& block, const Projector& projector) {
  projectBlock<kModel, Field::image>(projector, block.points);
  keepProjected(block.points);
}
template <LensModel kModel>
void lookBaseline(ColouringBlock& block, const Projector& projector) {
  lookLoop<kModel>(block, projector);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX2 void lookAvx2(ColouringBlock& block, const Projector& projector) {
  lookLoop<kModel>(block, projector);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX512 void lookAvx512(ColouringBlock& block, const Projector& projector) {
  lookLoop<kModel>(block, projector);
}

void look(ColouringBlock& block, const Projector& projector, CpuLevel level) {
  withLensModel(projector.lens.model, [&](auto model) {
    if (level == CpuLevel::avx512) return lookAvx512<model.value>(block, projector);
    if (level == CpuLevel::avx2) return lookAvx2<model.value>(block, projector);
    lookBaseline<model.value>(block, projector);
  });
}

THERMOVOX_INLINE_LOOP void sampleLoop(ColouringBlock& block, const LocalVariance& image) {
  findCells(block, image.stride());
  readTemperatures(block, image.texels(), image.stride());
  sampleCorners(block, 0.0F);
}
void sampleBaseline(ColouringBlock& block, const LocalVariance& image) {
  sampleLoop(block, image);
}
THERMOVOX_TARGET_AVX2 void sampleAvx2(ColouringBlock& block, const LocalVariance& image) {
  sampleLoop(block, image);
}
THERMOVOX_TARGET_AVX512 void sampleAvx512(ColouringBlock& block, const LocalVariance& image) {
  sampleLoop(block, image);
}

void sample(ColouringBlock& block, const LocalVariance& image, CpuLevel level) {
  if (level == CpuLevel::avx512) return sampleAvx512(block, image);
  if (level == CpuLevel::avx2) return sampleAvx2(block, image);
  sampleBaseline(block, image);
}

/// Temperature and sigma of the points in the image.
template <LensModel kModel>
THERMOVOX_INLINE_LOOP void judgeLoop(ColouringBlock& block, const SeeingFrame& frame) {
  const LocalVariance& image = frame.view.local_variance;
  findCells(block, image.stride());
  findErrors<kModel>(block, frame.view.projector, image.shares());
  readTemperatures(block, image.texels(), image.stride());
  readVariances(block, image.texels(), image.stride());
  sampleCorners(block, static_cast<float>(frame.view.noise));
  sumErrors(block);
}
template <LensModel kModel>
void judgeBaseline(ColouringBlock& block, const SeeingFrame& frame) {
  judgeLoop<kModel>(block, frame);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX2 void judgeAvx2(ColouringBlock& block, const SeeingFrame& frame) {
  judgeLoop<kModel>(block, frame);
}
template <LensModel kModel>
THERMOVOX_TARGET_AVX512 void judgeAvx512(ColouringBlock& block, const SeeingFrame& frame) {
  judgeLoop<kModel>(block, frame);
}

void judge(ColouringBlock& block, const SeeingFrame& frame, CpuLevel level) {
  withLensModel(frame.view.projector.lens.model, [&](auto model) {
    if (level == CpuLevel::avx512) return judgeAvx512<model.value>(block, frame);
    if (level == CpuLevel::avx2) return judgeAvx2<model.value>(block, frame);
    judgeBaseline<model.value>(block, frame);
  });
}

void correctBaseline(ColouringBlock& block, const AirPath& air) {
  correctForAir(block, air);
}
THERMOVOX_TARGET_AVX2 void correctAvx2(ColouringBlock& block, const AirPath& air) {
  correctForAir(block, air);
}
THERMOVOX_TARGET_AVX512 void correctAvx512(ColouringBlock& block, const AirPath& air) {
  correctForAir(block, air);
}

void correct(ColouringBlock& block, const AirPath& air, CpuLevel level) {
  if (level == CpuLevel::avx512) return correctAvx512(block, air);
  if (level == CpuLevel::avx2) return correctAvx2(block, air);
  correctBaseline(block, air);
}

void askOccluder(ColouringBlock& block, const SeeingFrame& frame, CpuLevel level) {
  const PointBlock& p = block.points;
  const auto column = [&](const BlockColumn<double>& values) {
    return std::span<const double>(values.data(), p.size);
  };
  frame.occluder.hide({frame.view.T_world_camera.translation, column(p.x), column(p.y), column(p.z),
                       column(p.u), column(p.v), column(p.depth), level},
                      std::span(block.hidden.data(), p.size));
}

/// Rows of what the block says, at the places of its points.
void writeColours(const ColouringBlock& block, std::span<PointColour> colours) {
  using Outcome = PointColour::Outcome;
  const PointBlock& p = block.points;
  if (p.size < colours.size()) std::fill(colours.begin(), colours.end(), PointColour());
  for (std::size_t i = 0; i < p.size; ++i) {
    const Outcome known = std::isnan(block.celsius[i]) ? Outcome::unknown_pixel : Outcome::coloured;
    colours[p.index[i]] = {p.u[i],         p.v[i],         block.celsius[i],
                           block.sigma[i], block.range[i], block.hidden[i] != 0 ? Outcome::hidden : known};
  }
}

}  // namespace

std::variant<Colour, NoColour> PointColour::by(Time frame_stamp) const {
  switch (outcome) {
    case Outcome::coloured:
      return Colour{frame_stamp, {u, v}, celsius, sigma, range};
    case Outcome::hidden:
      return NoColour::hidden;
    case Outcome::unknown_pixel:
      return NoColour::unknown_pixel;
    case Outcome::outside_image:
      break;
  }
  return NoColour::outside_image;
}

ColouringBatch::ColouringBatch(CpuLevel level) : level_(level), block_(std::make_unique<ColouringBlock>()) {}
ColouringBatch::~ColouringBatch() = default;
ColouringBatch::ColouringBatch(ColouringBatch&&) noexcept = default;
ColouringBatch& ColouringBatch::operator=(ColouringBatch&&) noexcept = default;

namespace {

/// The memory brings the next block while this one is worked on.
void prefetch(const PlacedReturn& point) {
  const char* const begin = reinterpret_cast<const char*>(&point);
  __builtin_prefetch(begin);
  __builtin_prefetch(begin + sizeof(PlacedReturn) - 1);
}

}  // namespace

template <typename PointAt>
std::span<const PointColour> ColouringBatch::colourEach(std::size_t count, const SeeingFrame& frame,
                                                        const PointAt& point_at) {
  colours_.resize(count);
  PointBlock& points = block_->points;
  for (std::size_t begin = 0; begin < count; begin += kBlockPoints) {
    const std::size_t size = std::min(kBlockPoints, count - begin);
    points.size = size;
    for (std::size_t i = 0; i < size; ++i) points.set(i, point_at(begin + i).p_world);
    const std::size_t next_end = std::min(count, begin + 2 * kBlockPoints);
    for (std::size_t i = begin + kBlockPoints; i < next_end; ++i) prefetch(point_at(i));
    look(*block_, frame.view.projector, level_);
    for (std::size_t i = 0; i < points.size; ++i) {
      const std::array<float, 6>& covariance = point_at(begin + points.index[i]).rig_covariance.entries;
      for (std::size_t k = 0; k < covariance.size(); ++k) block_->covariance[k][i] = covariance[k];
    }
    if (points.size > 0) {
      askOccluder(*block_, frame, level_);
      judge(*block_, frame, level_);
      const AirPath* const air = frame.view.frame.image->air.get();
      if (air != nullptr) correct(*block_, *air, level_);
    }
    writeColours(*block_, std::span(colours_).subspan(begin, size));
  }
  return colours_;
}

std::span<const PointColour> ColouringBatch::colour(std::span<const PlacedReturn> points,
                                                    const SeeingFrame& frame) {
  return colourEach(points.size(), frame, [&](std::size_t i) -> const PlacedReturn& { return points[i]; });
}

std::span<const PointColour> ColouringBatch::colour(std::span<const PlacedReturn> points,
                                                    std::span<const std::uint32_t> which,
                                                    const SeeingFrame& frame) {
  return colourEach(which.size(), frame,
                    [&](std::size_t i) -> const PlacedReturn& { return points[which[i]]; });
}

std::span<const float> ColouringBatch::sample(std::span<const Eigen::Vector3d> points_world,
                                              const ThermalView& view) {
  celsius_.assign(points_world.size(), std::numeric_limits<float>::quiet_NaN());
  PointBlock& points = block_->points;
  for (std::size_t begin = 0; begin < points_world.size(); begin += kBlockPoints) {
    points.size = std::min(kBlockPoints, points_world.size() - begin);
    for (std::size_t i = 0; i < points.size; ++i) points.set(i, points_world[begin + i]);
    look(*block_, view.projector, level_);
    if (points.size > 0) thermovox::sample(*block_, view.local_variance, level_);
    for (std::size_t i = 0; i < points.size; ++i) celsius_[begin + points.index[i]] = block_->celsius[i];
  }
  return celsius_;
}

}  // namespace thermovox
