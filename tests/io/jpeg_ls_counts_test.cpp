#include "io/jpeg_ls_counts.hpp"

#include <charls/charls.h>
#include <gmock/gmock.h>

#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::HasSubstr;

struct Picture {
  int width = 0;
  int height = 0;
  int bits = 16;
  std::vector<std::uint16_t> samples;
};

/// An encoder that we did not write.
std::string encodedByCharls(const Picture& picture, const charls::jpegls_pc_parameters& presets = {},
                            int near = 0) {
  charls::jpegls_encoder encoder;
  encoder.frame_info({static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height),
                      picture.bits, 1});
  encoder.preset_coding_parameters(presets);
  encoder.near_lossless(near);
  std::string bytes(encoder.estimated_destination_size() + 4096, '\0');
  encoder.destination(bytes);
  bytes.resize(encoder.encode(picture.samples));
  return bytes;
}

CountsPicture decode(const std::string& bytes) {
  return decodeJpegLsCounts(std::as_bytes(std::span(bytes)), "picture");
}

/// Smooth, flat in places (runs), with single steps, or pure noise over all bits.
Picture randomPicture(std::mt19937_64& random) {
  Picture picture{.width = 1 + static_cast<int>(random() % 70),
                  .height = 1 + static_cast<int>(random() % 40)};
  picture.bits = 9 + static_cast<int>(random() % 8);
  const std::uint64_t all = (std::uint64_t{1} << picture.bits) - 1;
  const std::uint64_t noises[] = {0, 1, 3, 40, all};
  const std::uint64_t noise = noises[random() % 5];
  const std::uint64_t flat_share = random() % 100;
  std::uint64_t level = random() & all;
  for (int i = 0; i < picture.width * picture.height; ++i) {
    if (random() % 100 >= flat_share) level += random() % 5;
    if (random() % 200 == 0) level = random();
    picture.samples.push_back(
        static_cast<std::uint16_t>((level + (noise == 0 ? 0 : random() % (noise + 1))) & all));
  }
  return picture;
}

TEST(DecodeJpegLsCounts, GivesWhatCharlsEncoded) {
  std::mt19937_64 random(17);
  for (int i = 0; i < 600; ++i) {
    const Picture picture = randomPicture(random);
    SCOPED_TRACE(testing::Message() << "picture " << i << ": " << picture.width << " x " << picture.height
                                    << ", " << picture.bits << " bits");
    const CountsPicture decoded = decode(encodedByCharls(picture));
    ASSERT_EQ(decoded.width, picture.width);
    ASSERT_EQ(decoded.counts, picture.samples);
  }
}

/// The picture as charls decodes it.
std::vector<std::uint16_t> decodedByCharls(const std::string& bytes) {
  charls::jpegls_decoder decoder(bytes, true);
  return decoder.decode<std::vector<std::uint16_t>>();
}

TEST(DecodeJpegLsCounts, GivesWhatCharlsDecodesOfPicturesThatAreNotExact) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 300; ++i) {
    const Picture picture = randomPicture(random);
    SCOPED_TRACE(testing::Message() << "picture " << i);
    const std::string bytes = encodedByCharls(picture, {}, 1 + static_cast<int>(random() % 30));
    ASSERT_EQ(decode(bytes).counts, decodedByCharls(bytes));
  }
}

TEST(DecodeJpegLsCounts, FollowsThePresetsOfThePicture) {
  std::mt19937_64 random(18);
  for (int i = 0; i < 50; ++i) {
    Picture picture = randomPicture(random);
    picture.bits = 16;
    EXPECT_EQ(decode(encodedByCharls(picture, {65535, 10, 100, 1000, 31})).counts, picture.samples);
  }
}

TEST(DecodeJpegLsCounts, RefusesAPictureThatIsCutOffAnywhere) {
  std::mt19937_64 random(19);
  for (int i = 0; i < 20; ++i) {
    const std::string bytes = encodedByCharls(randomPicture(random));
    for (std::size_t size = 0; size + 6 < bytes.size(); size += 1 + bytes.size() / 200) {
      SCOPED_TRACE(testing::Message() << "picture " << i << ", " << size << " of " << bytes.size());
      EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(bytes.substr(0, size))); }),
                  HasSubstr("picture "));
    }
  }
}

TEST(DecodeJpegLsCounts, ComesToAnEndWhateverTheBytes) {
  std::mt19937_64 random(20);
  for (int i = 0; i < 400; ++i) {
    std::string bytes = encodedByCharls(randomPicture(random));
    for (int k = 0; k < 3; ++k) bytes[20 + random() % (bytes.size() - 20)] = static_cast<char>(random());
    try {
      EXPECT_FALSE(decode(bytes).counts.empty());
    } catch (const DataError&) {
    }
  }
}

TEST(DecodeJpegLsCounts, RefusesOtherPicturesByTheirChannels) {
  const Picture eight_bits{.width = 4, .height = 3, .bits = 8, .samples = std::vector<std::uint16_t>(12)};
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(encodedByCharls(eight_bits))); }),
              HasSubstr("1 channel(s) of 8 bits"));
}

}  // namespace
}  // namespace thermovox
