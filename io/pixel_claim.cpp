#include "io/pixel_claim.hpp"

#include "projection/error.hpp"

namespace thermovox {
namespace {

/// No codec packs pixels tighter than about this, so few bytes that claim a large image are damaged.
constexpr std::uint64_t kTightestPacking = 10'000;

}  // namespace

void checkClaim(const PixelClaim& claim, const std::string& what) {
  const bool countable = claim.width <= kMostPixels && claim.height <= kMostPixels;
  const std::uint64_t pixels = countable ? claim.width * claim.height : 0;
  if (pixels == 0 || pixels > kMostPixels ||
      pixels * claim.bytes_per_pixel / kTightestPacking > claim.stored_bytes) {
    throw DataError(what + " claims " + std::to_string(claim.width) + " x " + std::to_string(claim.height) +
                    " pixels in " + std::to_string(claim.stored_bytes) + " bytes, expected a thermal image");
  }
}

}  // namespace thermovox
