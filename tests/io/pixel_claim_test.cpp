#include "io/pixel_claim.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

void expectRefused(const PixelClaim& claim, const std::string& words) {
  EXPECT_THAT(
      test::messageOf<DataError>([&] { checkClaim(claim, "image.tiff: page 3"); }),
      testing::AllOf(HasSubstr("image.tiff: page 3 claims " + words), HasSubstr("expected a thermal image")));
}

TEST(CheckClaim, LetsThermalImagesPass) {
  EXPECT_NO_THROW(checkClaim({160, 120, 2, 2 * 160 * 120}, "image"));
  EXPECT_NO_THROW(checkClaim({1024, 768, 4, 20000}, "packed image"));
}

TEST(CheckClaim, DrawsTheLineBehindAHundredMillionPixels) {
  EXPECT_NO_THROW(checkClaim({10'000, 10'000, 2, kMost}, "image"));
  EXPECT_NO_THROW(checkClaim({kMostPixels, 1, 2, kMost}, "image"));
  expectRefused({10'000, 10'001, 2, kMost}, "10000 x 10001 pixels");
  expectRefused({kMostPixels + 1, 1, 2, kMost}, "100000001 x 1 pixels");
  expectRefused({60'000, 60'000, 2, kMost}, "60000 x 60000 pixels");
}

TEST(CheckClaim, RefusesAnImageOfNothing) {
  expectRefused({0, 120, 2, 1000}, "0 x 120 pixels in 1000 bytes");
  expectRefused({160, 0, 2, 1000}, "160 x 0 pixels in 1000 bytes");
}

TEST(CheckClaim, IsNotDeceivedByProductsThatOverflow) {
  const std::uint64_t half = std::uint64_t{1} << 32;
  expectRefused({half, half, 2, kMost}, "4294967296 x 4294967296 pixels");
  expectRefused({kMost, kMost, 2, kMost}, "18446744073709551615 x 18446744073709551615 pixels");
  expectRefused({half / 2 + 1, 2, 2, kMost}, "2147483649 x 2 pixels");
}

TEST(CheckClaim, RefusesMoreThanAnyCodecPacks) {
  // 1000 x 1000 pixels of 2 bytes are 200 times as many as 10000 bytes of packed ones.
  EXPECT_NO_THROW(checkClaim({1000, 1000, 2, 200}, "image"));
  expectRefused({1000, 1000, 2, 199}, "1000 x 1000 pixels in 199 bytes");
  expectRefused({1000, 1000, 4, 399}, "1000 x 1000 pixels in 399 bytes");
}

TEST(CheckClaim, AllowsAnySmallImageForItsFewBytes) {
  EXPECT_NO_THROW(checkClaim({2, 2, 2, 0}, "image")) << "what reads it says that it is cut off";
}

}  // namespace
}  // namespace thermovox
