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
  std::string bytes(encoder.estimated_destination_size() + 4096 + picture.samples.size() / 4, '\0');
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

/// The two bytes of a preset, in the order of the standard: largest value, three thresholds, reset.
std::string withPreset(std::string bytes, std::size_t preset, unsigned value) {
  const std::size_t segment = bytes.find(std::string("\xFF\xF8\0\x0D\x01", 5));
  EXPECT_NE(segment, std::string::npos);
  bytes[segment + 5 + 2 * preset] = static_cast<char>(value >> 8);
  bytes[segment + 6 + 2 * preset] = static_cast<char>(value);
  return bytes;
}

/// Presets as far apart as the standard allows.
std::vector<charls::jpegls_pc_parameters> extremePresets() {
  return {{65535, 18, 67, 276, 65535},      {65535, 18, 67, 276, 3},        {65535, 1, 1, 1, 64},
          {65535, 65535, 65535, 65535, 64}, {65535, 1, 65535, 65535, 64},   {65535, 1, 1, 65535, 64},
          {65535, 1, 1, 1, 65535},          {65535, 65535, 65535, 65535, 3}};
}

TEST(DecodeJpegLsCounts, FollowsPresetsAtTheirLimits) {
  std::mt19937_64 random(22);
  for (const charls::jpegls_pc_parameters& presets : extremePresets()) {
    for (int i = 0; i < 20; ++i) {
      Picture picture = randomPicture(random);
      picture.bits = 16;
      SCOPED_TRACE(testing::Message() << "thresholds " << presets.threshold1 << " " << presets.threshold2
                                      << " " << presets.threshold3 << ", reset " << presets.reset_value);
      const std::string bytes = encodedByCharls(picture, presets);
      ASSERT_EQ(decodedByCharls(bytes), picture.samples);
      ASSERT_EQ(decode(bytes).counts, picture.samples);
    }
  }
}

/// A large calm picture learns without a reset what one of 65535 would forget.
TEST(DecodeJpegLsCounts, FollowsAResetThatNeverOrHardlyComes) {
  std::mt19937_64 random(23);
  Picture picture{.width = 640, .height = 512};
  for (int i = 0; i < picture.width * picture.height; ++i)
    picture.samples.push_back(static_cast<std::uint16_t>(17000 + i / 5000 + static_cast<int>(random() % 40)));
  for (const int reset : {3, 64, 40000, 65535}) {
    const std::string bytes = encodedByCharls(picture, {65535, 18, 67, 276, reset});
    EXPECT_EQ(decode(bytes).counts, picture.samples) << reset;
  }
}

/// Errors of all sizes that no reset makes smaller sum up beyond 24 bits, which charls takes for damage too.
TEST(DecodeJpegLsCounts, FollowsNoiseAsFarAsCharlsDoes) {
  std::mt19937_64 random(24);
  Picture picture{.width = 200, .height = 200};
  for (int i = 0; i < picture.width * picture.height; ++i)
    picture.samples.push_back(static_cast<std::uint16_t>(random()));
  for (const charls::jpegls_pc_parameters& presets : extremePresets()) {
    std::string bytes;
    try {
      bytes = encodedByCharls(picture, presets);
    } catch (const charls::jpegls_error&) {
      EXPECT_EQ(presets.reset_value, 65535);
      continue;
    }
    EXPECT_EQ(decode(bytes).counts, picture.samples);
  }
}

TEST(DecodeJpegLsCounts, RefusesErrorsThatGrowWithoutEnd) {
  std::mt19937_64 random(27);
  Picture picture{.width = 400, .height = 400};
  for (int i = 0; i < picture.width * picture.height; ++i)
    picture.samples.push_back(static_cast<std::uint16_t>(random()));
  // Encoded with a reset at 64 errors, and said to have none: what is decoded is noise as well.
  std::string bytes = encodedByCharls(picture, {65535, 18, 67, 276, 63});
  bytes = withPreset(bytes, 4, 65535);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(bytes)); }),
              HasSubstr("picture is a damaged JPEG-LS picture"));
}

TEST(DecodeJpegLsCounts, RefusesPresetsThatCannotBe) {
  std::mt19937_64 random(25);
  Picture picture = randomPicture(random);
  picture.bits = 12;
  for (std::uint16_t& sample : picture.samples) sample &= 0xFFF;
  const std::string bytes = encodedByCharls(picture, {4095, 10, 100, 1000, 31});
  ASSERT_EQ(decode(bytes).counts, picture.samples);
  const std::pair<std::size_t, unsigned> impossible[] = {{0, 4096}, {0, 65535}, {0, 999},  {1, 101}, {2, 9},
                                                         {2, 1001}, {3, 99},    {3, 4096}, {4, 1},   {4, 2}};
  for (const auto& [preset, value] : impossible) {
    const std::string crafted = withPreset(bytes, preset, value);
    EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(crafted)); }),
                HasSubstr("its presets cannot be"))
        << "preset " << preset << ": " << value;
  }
}

TEST(DecodeJpegLsCounts, ComesToAnEndWhateverThePresets) {
  std::mt19937_64 random(26);
  const unsigned extremes[] = {0, 1, 2, 3, 255, 256, 32767, 32768, 65534, 65535};
  for (int i = 0; i < 300; ++i) {
    Picture picture = randomPicture(random);
    picture.bits = 16;
    std::string bytes = encodedByCharls(picture, {65535, 10, 100, 1000, 31});
    for (std::size_t preset = 0; preset < 5; ++preset) {
      if (random() % 2 == 0) bytes = withPreset(bytes, preset, extremes[random() % std::size(extremes)]);
    }
    try {
      EXPECT_EQ(decode(bytes).counts.size(), picture.samples.size());
    } catch (const DataError&) {
    }
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
