#include "io/xmp.hpp"

#include <gmock/gmock.h>

namespace thermovox {
namespace {

TEST(Xmp, ReadsAttributesAndElements) {
  const std::string packet = R"(<x:xmpmeta><rdf:RDF><rdf:Description rdf:about="" FLIR:TlinearGain="0.04"
    Camera:Yaw = '16319/100' Other:NotYaw="1"><Camera:Pitch>
    -87.5 </Camera:Pitch><Camera:Empty/><Camera:PerspectiveDistortion><rdf:Seq><rdf:li>-0.36</rdf:li>
    <rdf:li>0.41</rdf:li></rdf:Seq></Camera:PerspectiveDistortion></rdf:Description></rdf:RDF></x:xmpmeta>)";
  EXPECT_EQ(xmpNumber(packet, "TlinearGain"), 0.04);
  EXPECT_EQ(xmpNumber(packet, "TlinearGain", "FLIR"), 0.04);
  EXPECT_EQ(xmpNumber(packet, "TlinearGain", "Camera"), std::nullopt);
  EXPECT_DOUBLE_EQ(xmpNumber(packet, "Yaw").value(), 163.19);
  EXPECT_EQ(xmpNumber(packet, "Pitch"), -87.5);
  EXPECT_EQ(xmpText(packet, "Empty"), std::nullopt);
  EXPECT_THAT(xmpText(packet, "PerspectiveDistortion").value(), testing::StartsWith("-0.36,"));
  EXPECT_THAT(xmpFacts(packet).perspective_distortion, testing::ElementsAre(-0.36, 0.41));
  EXPECT_EQ(xmpFacts(packet).roll_deg, std::nullopt);
}

TEST(Xmp, FindsNothingInDamagedPackets) {
  for (const char* packet : {"", "TlinearGain", ":TlinearGain", "a:TlinearGain=", "a:TlinearGain=\"0.04",
                             "<a:TlinearGain>0.04", "<a:TlinearGain", "<a:TlinearGain>nan</a:TlinearGain>",
                             "a:TlinearGain=\"1/0\"", "a:TlinearGain=\"warm\"", "</a:TlinearGain>0.04</b>"}) {
    EXPECT_EQ(xmpNumber(packet, "TlinearGain"), std::nullopt) << packet;
  }
}

}  // namespace
}  // namespace thermovox
