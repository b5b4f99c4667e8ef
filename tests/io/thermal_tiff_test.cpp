#include "io/thermal_tiff.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"
#include "tests/io/tiff_writer.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using test::TiffForm;
using test::TiffPages;
using testing::AllOf;
using testing::HasSubstr;

constexpr TLinear kDuoR{};

/// A page, its counts by the scale of the user's option.
template <typename File>
ThermalImage decode(const File& file, int page, const TLinear& t_linear) {
  return CelsiusDecoder().decode(openThermalRecording(file, {.t_linear = t_linear})->read(page), "image");
}

int pagesOf(const std::filesystem::path& file) {
  return openThermalRecording(file)->frames();
}

TiffPages<std::uint16_t> randomCounts(int width, int height, int pages) {
  std::mt19937_64 random(5);
  TiffPages<std::uint16_t> result{width, height, {}};
  for (int page = 0; page < pages; ++page) {
    std::vector<std::uint16_t> counts(static_cast<std::size_t>(width * height));
    for (std::uint16_t& count : counts) count = static_cast<std::uint16_t>(28000 + random() % 5000);
    result.pages.push_back(counts);
  }
  return result;
}

void expectCounts(const ThermalImage& image, const TiffPages<std::uint16_t>& written, int page) {
  ASSERT_EQ(image.width, written.width);
  ASSERT_EQ(image.height, written.height);
  const auto& counts = written.pages[static_cast<std::size_t>(page)];
  ASSERT_EQ(image.celsius.size(), counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    ASSERT_EQ(image.celsius[i], kDuoR.celsius(counts[i])) << "pixel " << i;
}

/// All the ways to lay a TIFF out that cameras and converters use.
std::vector<TiffForm> forms() {
  return {{},
          {.rows_per_strip = 1000},
          {.compression = 5},
          {.compression = 5, .predictor = 2},
          {.compression = 8, .predictor = 2},
          {.compression = 32773},
          {.photometric = false},
          {.big_endian = true},
          {.compression = 5, .predictor = 2, .big_endian = true},
          {.big_tiff = true},
          {.tile = 16},
          {.tile = 32, .compression = 8, .predictor = 2, .big_endian = true}};
}

TEST(ThermalTiff, ReadsCountsInEveryLayout) {
  const test::TestFolder folder;
  const auto counts = randomCounts(37, 29, 1);  // no multiple of strips or tiles
  for (std::size_t i = 0; i < forms().size(); ++i) {
    SCOPED_TRACE(testing::Message() << "form " << i);
    const auto file = folder / (std::to_string(i) + ".tiff");
    writeTiff(file, counts, forms()[i]);
    expectCounts(decode(file, 0, kDuoR), counts, 0);
    const std::string bytes = test::bytesOf(file);
    const auto in_memory =
        openThermalRecording(std::as_bytes(std::span(bytes)), "memory", {.t_linear = kDuoR});
    expectCounts(CelsiusDecoder().decode(in_memory->read(0), "memory"), counts, 0);
  }
}

TEST(ThermalTiff, ReadsEveryPage) {
  const test::TestFolder folder;
  const auto counts = randomCounts(16, 12, 5);
  writeTiff(folder / "video.tiff", counts, {.compression = 5});
  EXPECT_EQ(pagesOf(folder / "video.tiff"), 5);
  const auto video = openThermalRecording(folder / "video.tiff", {.t_linear = kDuoR});
  for (const int page : {0, 1, 2, 3, 4, 0, 3, 3, 1}) {
    expectCounts(decode(folder / "video.tiff", page, kDuoR), counts, page);
    expectCounts(CelsiusDecoder().decode(video->read(page), "image"), counts, page);
  }
  for (const int page : {5, -1, 1 << 20}) {
    EXPECT_THAT(
        messageOf<DataError>([&] { static_cast<void>(decode(folder / "video.tiff", page, kDuoR)); }),
        AllOf(HasSubstr("video.tiff: has no page " + std::to_string(page)), HasSubstr("expected 0 to 4")));
  }
}

TEST(ThermalTiff, ReadsFloatsAsCelsius) {
  const test::TestFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const TiffPages<float> celsius{3, 2, {{0.0F, 21.5F, -40.25F, nan, -9999.0F, INFINITY}}};
  for (const TiffForm& form :
       {TiffForm{}, TiffForm{.compression = 8, .predictor = 3}, TiffForm{.big_endian = true}}) {
    writeTiff(folder / "c.tiff", celsius, form);
    const ThermalImage image = decode(folder / "c.tiff", 0, kDuoR);
    EXPECT_EQ(image.at(0, 0), 0.0F);
    EXPECT_EQ(image.at(1, 0), 21.5F);
    EXPECT_EQ(image.at(2, 0), -40.25F);
    EXPECT_TRUE(std::isnan(image.at(0, 1)));
    EXPECT_TRUE(std::isnan(image.at(1, 1))) << "a common mark for no data";
    EXPECT_TRUE(std::isnan(image.at(2, 1)));
  }
}

TEST(ThermalTiff, TakesAnEmptyPixelForUnknown) {
  const test::TestFolder folder;
  writeTiff(folder / "c.tiff", TiffPages<std::uint16_t>{2, 1, {{0, 31730}}});
  const ThermalImage image = decode(folder / "c.tiff", 0, kDuoR);
  EXPECT_TRUE(std::isnan(image.at(0, 0)));
  EXPECT_FLOAT_EQ(image.at(1, 0), 44.15F);
}

TEST(ThermalTiff, RefusesPicturesByTheirPixels) {
  const test::TestFolder folder;
  writeTiff(folder / "picture.tiff", TiffPages<std::uint8_t>{2, 2, {{1, 2, 3, 4}}});
  EXPECT_THAT(
      messageOf<DataError>([&] { static_cast<void>(decode(folder / "picture.tiff", 0, kDuoR)); }),
      AllOf(HasSubstr("picture.tiff: has 1 sample(s) of 8 bits"), HasSubstr("expected one of 16 bits")));
}

TEST(ThermalTiff, NamesTheFileThatIsTruncated) {
  const test::TestFolder folder;
  for (const TiffForm& form :
       {TiffForm{}, TiffForm{.compression = 5, .predictor = 2}, TiffForm{.tile = 16}}) {
    const auto counts = randomCounts(40, 30, 1);
    writeTiff(folder / "whole.tiff", counts, form);
    const std::string whole = test::bytesOf(folder / "whole.tiff");
    testing::internal::CaptureStderr();
    for (std::size_t size = 0; size < whole.size(); size += 37) {
      SCOPED_TRACE(testing::Message() << size << " of " << whole.size() << " bytes");
      const auto file = folder.write("cut.tiff", whole.substr(0, size));
      EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(file, 0, kDuoR)); }),
                  HasSubstr("cut.tiff: "));
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library never prints";
  }
}

/// The file with another width and height in its directory, whose entries are of 16 x 12 pixels: tag, type
/// SHORT (then LONG), count 1, value, all little endian.
std::string claiming(std::string bytes, std::uint32_t width, std::uint32_t height) {
  for (const auto& [tag, found, claim] : {std::tuple{'\x00', '\x10', width}, {'\x01', '\x0C', height}}) {
    const std::string entry =
        std::string(1, tag) + std::string("\x01\x03\x00\x01\x00\x00\x00", 7) + found + std::string(3, '\0');
    const std::size_t place = bytes.find(entry);
    EXPECT_NE(place, std::string::npos);
    bytes[place + 2] = '\x04';
    for (std::size_t i = 0; i < 4; ++i) bytes[place + 8 + i] = static_cast<char>(claim >> 8 * i);
  }
  return bytes;
}

TEST(ThermalTiff, TakesNoMemoryForAnImageThatItsFileCannotHold) {
  const test::TestFolder folder;
  writeTiff(folder / "small.tiff", randomCounts(16, 12, 1), {.rows_per_strip = 12});
  const std::string small = test::bytesOf(folder / "small.tiff");
  const test::MemoryLimit limit(256'000'000);
  for (const auto& [width, height] : {std::pair{0x7F000000U, 12U}, {60'000U, 60'000U}, {10'000U, 10'000U}}) {
    const auto file = folder.write("absurd.tiff", claiming(small, width, height));
    EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(file, 0, kDuoR)); }),
                AllOf(HasSubstr("absurd.tiff: claims " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels"),
                      HasSubstr("expected a thermal image")));
  }
}

TEST(ThermalTiff, TakesNoMemoryForAClaimBesideManyBytes) {
  const test::TestFolder folder;
  writeTiff(folder / "small.tiff", randomCounts(16, 12, 1), {.rows_per_strip = 12});
  const std::string padding(2'000'000, 'x');  // enough for 60000 x 60000 pixels, tightly packed
  const auto file =
      folder.write("padded.tiff", claiming(test::bytesOf(folder / "small.tiff"), 60'000, 60'000) + padding);
  const test::MemoryLimit limit(256'000'000);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(decode(file, 0, kDuoR)); }),
              HasSubstr("padded.tiff: claims 60000 x 60000 pixels"));
}

TEST(OpenThermalRecording, RefusesOtherKindsByName) {
  const test::TestFolder folder;
  const auto complaint = [&](std::string_view content) {
    const auto file = folder.write("image.tiff", content);  // whatever its name says
    return messageOf<DataError>([&] { static_cast<void>(decode(file, 0, kDuoR)); });
  };
  EXPECT_THAT(complaint("\xFF\xD8\xFF\xE0 JFIF"),
              AllOf(HasSubstr("image.tiff: is a JPEG"), HasSubstr("expected")));
  EXPECT_THAT(complaint("\x89PNG\r\n"), HasSubstr("is a PNG picture"));
  EXPECT_THAT(complaint("hello"), HasSubstr("is no image of a known kind"));
  EXPECT_THAT(complaint(""), HasSubstr("is empty"));
  EXPECT_THAT(messageOf<DataError>([&] {
                static_cast<void>(openThermalRecording(folder / "no.tiff", {.named_by = "thermal.csv:3"}));
              }),
              HasSubstr("no.tiff (named by thermal.csv:3): no such file"));
}

TEST(ThermalTiff, GivesTheCountsOfRealCameras) {
  THERMOVOX_NEEDS_RECORDINGS();
  const auto folder = *test::recordings() / "thermal";
  const auto reference = nlohmann::json::parse(test::bytesOf(folder / "reference.json")).at("tlinear_tiff");
  ASSERT_GE(reference.size(), 4U);
  constexpr TLinear kCounts{1.0, 0.0};
  for (const auto& [name, expected] : reference.items()) {
    SCOPED_TRACE(name);
    const ThermalImage image = decode(folder / name, 0, kCounts);
    EXPECT_EQ(image.width, expected.at("wh").at(0).get<int>());
    EXPECT_EQ(image.height, expected.at("wh").at(1).get<int>());
    EXPECT_EQ(pagesOf(folder / name), expected.at("pages").get<int>());
    for (const auto& [where, pixel] : expected.at("raw_pixels").items()) {
      const auto xy = pixel.at("xy").get<std::array<int, 2>>();
      EXPECT_EQ(image.at(xy[0], xy[1]), pixel.at("v").get<float>()) << where;
    }
    double sum = 0.0;
    for (const float count : image.celsius) sum += count;
    EXPECT_NEAR(sum / static_cast<double>(image.celsius.size()), expected.at("raw_mean").get<double>(), 1e-3);
  }
}

TEST(ThermalTiff, ReadsAFileWithoutPhotometricTag) {
  THERMOVOX_NEEDS_RECORDINGS();
  const ThermalImage image =
      decode(*test::recordings() / "thermal/tiff/Sensefly_Thermomap_9mm.tif", 0, {0.01, -100.0});
  const auto [coldest, warmest] = std::minmax_element(image.celsius.begin(), image.celsius.end());
  EXPECT_NEAR(*coldest, 15.58, 0.01);  // counts 11558 to 13712
  EXPECT_NEAR(*warmest, 37.12, 0.01);
}

}  // namespace
}  // namespace thermovox
