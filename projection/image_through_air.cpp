#include "projection/image_through_air.hpp"

namespace thermovox {

ThermalImage imageThroughAir(const ThermalImage& image, std::span<const double> distances) {
  ThermalImage result = image;
  if (!image.air) return result;
  result.air = nullptr;
  for (std::size_t i = 0; i < result.celsius.size(); ++i)
    result.celsius[i] = static_cast<float>(image.air->at(image.celsius[i], distances[i]).celsius);
  return result;
}

}  // namespace thermovox
