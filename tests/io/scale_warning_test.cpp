#include "io/scale_warning.hpp"

#include <gmock/gmock.h>

namespace thermovox {
namespace {

using testing::AllOf;
using testing::HasSubstr;

RawThermalImage imageOf(const CelsiusRule& rule, RuleSource source, std::optional<double> gain = {}) {
  RawThermalImage image{.width = 1, .height = 1, .counts = {30000}, .rule = rule, .rule_source = source};
  image.metadata.xmp.t_linear_gain = gain;
  return image;
}

std::optional<std::string> warningOf(const RawThermalImage& image) {
  return scaleWarning(image, "a.tiff", {"the rig", "its key"});
}

TEST(ScaleWarning, TellsAGuess) {
  const auto warning = warningOf(imageOf(TLinear{0.04, kAbsoluteZero}, RuleSource::counts));
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, AllOf(testing::StartsWith("a.tiff: "), HasSubstr("0.04 C a count"),
                              HasSubstr("above -273.15 C"), HasSubstr("give its key")));
}

TEST(ScaleWarning, NamesBothScalesWhereFileAndRigContradictOneAnother) {
  const auto gain = warningOf(imageOf(TLinear{0.01, kAbsoluteZero}, RuleSource::option, 0.04));
  ASSERT_TRUE(gain);
  EXPECT_THAT(*gain,
              AllOf(testing::StartsWith("a.tiff: "), HasSubstr("0.04 C a count above -273.15 C by the file"),
                    HasSubstr("0.01 C a count above -273.15 C by the rig, which is taken")));
  EXPECT_TRUE(warningOf(imageOf(TLinear{0.04, -100.0}, RuleSource::option, 0.04))) << "another offset";
  const auto none = warningOf(imageOf(TLinear{0.01, kAbsoluteZero}, RuleSource::option, 0.0));
  ASSERT_TRUE(none);
  EXPECT_THAT(*none, HasSubstr("no temperatures (TlinearGain 0) by the file"));
}

TEST(ScaleWarning, IsSilentWhereNothingIsInDoubt) {
  const TLinear duo{0.01, kAbsoluteZero};
  EXPECT_FALSE(warningOf(imageOf(duo, RuleSource::option)));
  EXPECT_FALSE(warningOf(imageOf(duo, RuleSource::option, 0.01)));
  EXPECT_FALSE(warningOf(imageOf(duo, RuleSource::option, 0.010000000001))) << "rounded";
  EXPECT_FALSE(warningOf(imageOf(duo, RuleSource::file, 0.01)));
  EXPECT_FALSE(warningOf(imageOf(duo, RuleSource::model)));
  EXPECT_FALSE(warningOf(imageOf(AlreadyCelsius{}, RuleSource::file)));
  EXPECT_FALSE(warningOf(imageOf(NotTemperature{"is of a Vue"}, RuleSource::counts)));
}

}  // namespace
}  // namespace thermovox
