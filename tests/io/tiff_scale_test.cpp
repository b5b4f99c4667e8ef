#include "io/tiff_scale.hpp"

#include <gmock/gmock.h>

namespace thermovox {
namespace {

using testing::HasSubstr;

std::vector<std::uint16_t> countsAbout(int middle) {
  std::vector<std::uint16_t> counts;
  for (int i = -50; i <= 50; ++i) counts.push_back(static_cast<std::uint16_t>(middle + i));
  return counts;
}

/// Degrees a count, or 0 for counts that are no temperatures.
double gainOf(const TiffEvidence& evidence, const std::vector<std::uint16_t>& counts) {
  const ScaleDecision decision = decideScale(evidence, counts);
  const auto* t_linear = std::get_if<TLinear>(&decision.rule);
  return t_linear == nullptr ? 0.0 : t_linear->celsius_per_count;
}

RuleSource sourceOf(const TiffEvidence& evidence, const std::vector<std::uint16_t>& counts) {
  return decideScale(evidence, counts).source;
}

std::string packetWith(const std::string& gain) {
  return "<rdf:Description FLIR:TlinearGain=\"" + gain + "\"/>";
}

TEST(DecideScale, HearsTheUserBeforeAllOthers) {
  const TiffEvidence evidence{
      .option = TLinear{0.5, -100.0}, .xmp = packetWith("0"), .make = "FLIR", .model = "Vue Pro 640"};
  EXPECT_EQ(gainOf(evidence, countsAbout(30000)), 0.5);
  EXPECT_EQ(sourceOf(evidence, countsAbout(30000)), RuleSource::option);
}

TEST(DecideScale, HearsThePacketBeforeTheModel) {
  const TiffEvidence evidence{.xmp = packetWith("0.4"), .make = "MicaSense", .model = "Altum"};
  EXPECT_EQ(gainOf(evidence, countsAbout(30000)), 0.4);
  EXPECT_EQ(sourceOf(evidence, countsAbout(30000)), RuleSource::file);
}

TEST(DecideScale, TakesAGainOf0ForNoTemperature) {
  for (const char* zero : {"0", "0.00", "0/100"}) {
    const ScaleDecision decision = decideScale({.xmp = packetWith(zero)}, countsAbout(30000));
    EXPECT_THAT(std::get<NotTemperature>(decision.rule).reason, HasSubstr("TlinearGain is 0")) << zero;
  }
}

TEST(DecideScale, KnowsCamerasByName) {
  EXPECT_EQ(gainOf({.make = "FLIR", .model = "Duo R"}, countsAbout(8000)), 0.01);
  EXPECT_EQ(gainOf({.make = "FLIR", .model = "Duo Pro R"}, countsAbout(8000)), 0.04);
  EXPECT_EQ(gainOf({.make = "FLIR", .model = "Duo Pro R"}, countsAbout(900)), 0.4) << "low gain";
  EXPECT_EQ(gainOf({.make = "FLIR", .model = "Vue Pro R 640 13mm"}, countsAbout(8000)), 0.04);
  EXPECT_EQ(gainOf({.make = "DJI", .model = "FLIR"}, countsAbout(7000)), 0.04);
  EXPECT_EQ(gainOf({.make = "", .model = "WIRIS640"}, countsAbout(7500)), 0.04);
  const auto thermo_map = decideScale({.make = "senseFly", .model = "thermoMAP"}, countsAbout(12000));
  EXPECT_EQ(std::get<TLinear>(thermo_map.rule).celsius_offset, -100.0);
  EXPECT_EQ(thermo_map.source, RuleSource::model);
}

TEST(DecideScale, RefusesACameraThatMeasuresNoTemperatures) {
  const auto decision = decideScale({.make = "FLIR", .model = "Vue Pro 640 9mm"}, countsAbout(8500));
  EXPECT_THAT(std::get<NotTemperature>(decision.rule).reason, HasSubstr("Vue Pro 640 9mm"));
}

TEST(DecideScale, GuessesByWhereTheCountsLieWhenNothingElseSpeaks) {
  EXPECT_EQ(gainOf({}, countsAbout(29315)), 0.01);
  EXPECT_EQ(gainOf({}, countsAbout(7328)), 0.04);
  EXPECT_EQ(gainOf({}, countsAbout(2931)), 0.1);
  EXPECT_EQ(gainOf({}, countsAbout(1500)), 0.4);
  EXPECT_EQ(sourceOf({}, countsAbout(29315)), RuleSource::counts);
  std::vector<std::uint16_t> with_empty_pixels = countsAbout(29315);
  with_empty_pixels.insert(with_empty_pixels.end(), 100, 0);
  EXPECT_EQ(gainOf({}, with_empty_pixels), 0.01);
}

TEST(DecideScale, GivesUpWhereNoScaleFits) {
  for (const int middle : {15000, 50000, 5000, 100}) {
    const auto decision = decideScale({}, countsAbout(middle));
    EXPECT_THAT(std::get<NotTemperature>(decision.rule).reason, HasSubstr("celsius_per_count")) << middle;
  }
  EXPECT_EQ(gainOf({}, std::vector<std::uint16_t>(10, 0)), 0.0);
  EXPECT_EQ(gainOf({}, {}), 0.0);
}

}  // namespace
}  // namespace thermovox
