#include "projection/grazing_emissivity.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr float kIndex2 = 1.5F * 1.5F;  // of refraction, squared

float reflectance(float cosine) {
  const float refracted = std::sqrt(kIndex2 - 1.0F + cosine * cosine);
  const float across = (cosine - refracted) / (cosine + refracted);
  const float along = (kIndex2 * cosine - refracted) / (kIndex2 * cosine + refracted);
  return 0.5F * (across * across + along * along);
}

}  // namespace

float emissivityLoss(float cosine) {
  static const float plain = 1.0F - reflectance(static_cast<float>(std::cos(kSteepestPlainView)));
  const float towards = 1.0F - reflectance(std::clamp(cosine, 0.0F, 1.0F));
  return std::max(1.0F - towards / plain, 0.0F);
}

}  // namespace thermovox
